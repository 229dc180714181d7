#pragma once
/// A subscriber of another vendor: Fast DDS, with types made from ROS 2's message definitions.

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/xmlparser/XMLProfileManager.h>

#include <condition_variable>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>

namespace s4tp::tests {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

/// ROS 2's name of package::msg::Type is package::msg::dds_::Type_.
template <class Message>
class RosType final : public dds::TopicDataType {
 public:
  explicit RosType(const std::string& package, const std::string& type) {
    setName((package + "::msg::dds_::" + type + "_").c_str());
    m_typeSize = 1U << 20;
    auto_fill_type_object(false);
    auto_fill_type_information(false);
  }
  bool serialize(void*, rtps::SerializedPayload_t*) override { return false; }
  bool deserialize(rtps::SerializedPayload_t* payload, void* data) override {
    try {
      eprosima::fastcdr::FastBuffer buffer(reinterpret_cast<char*>(payload->data), payload->length);
      eprosima::fastcdr::Cdr cdr(buffer, eprosima::fastcdr::Cdr::DEFAULT_ENDIAN,
                                 eprosima::fastcdr::Cdr::DDS_CDR);
      cdr.read_encapsulation();
      static_cast<Message*>(data)->deserialize(cdr);
      return true;
    } catch (const std::exception&) {
      return false;
    }
  }
  std::function<uint32_t()> getSerializedSizeProvider(void*) override {
    return [] { return 0U; };
  }
  void* createData() override { return new Message; }
  void deleteData(void* data) override { delete static_cast<Message*>(data); }
  bool getKey(void*, rtps::InstanceHandle_t*, bool) override { return false; }
};

/// Loopback has no multicast: peers are asked one by one, and shared memory of its own is of no use.
class RosNode {
 public:
  explicit RosNode(std::uint32_t domain) {
    // Two nodes of one process speak over the wire too: the short way between them is a fault of Fast DDS 2.9,
    // which tells a reader of the node that has just gone (a segmentation fault in one run of a hundred).
    eprosima::fastrtps::LibrarySettingsAttributes settings;
    settings.intraprocess_delivery = eprosima::fastrtps::INTRAPROCESS_OFF;
    eprosima::fastrtps::xmlparser::XMLProfileManager::library_settings(settings);
    dds::DomainParticipantQos qos;
    qos.transport().use_builtin_transports = false;
    const auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
    udp->interfaceWhiteList.push_back("127.0.0.1");
    udp->maxInitialPeersRange = 120;
    qos.transport().user_transports.push_back(udp);
    rtps::Locator_t peer;
    peer.kind = LOCATOR_KIND_UDPv4;
    rtps::IPLocator::setIPv4(peer, 127, 0, 0, 1);
    qos.wire_protocol().builtin.initialPeersList.push_back(peer);
    participant_ = dds::DomainParticipantFactory::get_instance()->create_participant(domain, qos);
    if (participant_ == nullptr) throw std::runtime_error("no Fast DDS participant");
    subscriber_ = participant_->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT);
  }
  ~RosNode() {
    participant_->delete_contained_entities();
    dds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
  }
  RosNode(const RosNode&) = delete;
  RosNode& operator=(const RosNode&) = delete;

  dds::DomainParticipant& participant() { return *participant_; }
  dds::Subscriber& subscriber() { return *subscriber_; }

 private:
  dds::DomainParticipant* participant_ = nullptr;
  dds::Subscriber* subscriber_ = nullptr;
};

/// Keeps the last message of a topic.
template <class Message>
class RosReader final : public dds::DataReaderListener {
 public:
  /// \param kept  asks for what was published before
  RosReader(RosNode& node, const std::string& topic, const std::string& package, const std::string& type,
            bool kept)
      : node_(node) {
    dds::TypeSupport(new RosType<Message>(package, type)).register_type(&node.participant());
    auto* const description = node.participant().lookup_topicdescription(topic);
    dds::TopicDescription* shown = description;
    if (shown == nullptr) {
      shown = node.participant().create_topic(topic, package + "::msg::dds_::" + type + "_",
                                              dds::TOPIC_QOS_DEFAULT);
    }
    dds::DataReaderQos qos = dds::DATAREADER_QOS_DEFAULT;
    qos.reliability().kind = dds::RELIABLE_RELIABILITY_QOS;
    qos.durability().kind = kept ? dds::TRANSIENT_LOCAL_DURABILITY_QOS : dds::VOLATILE_DURABILITY_QOS;
    qos.history().depth = 10;  // as ROS 2 does
    qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
    reader_ = node.subscriber().create_datareader(shown, qos, this);
    if (reader_ == nullptr) throw std::runtime_error(topic + ": no Fast DDS reader");
  }
  ~RosReader() {
    reader_->set_listener(nullptr);  // messages still come, and this object goes first
    node_.subscriber().delete_datareader(reader_);
  }

  void on_subscription_matched(dds::DataReader*, const dds::SubscriptionMatchedStatus& status) override {
    const std::lock_guard lock(mutex_);
    matched_ = status.current_count;
  }
  void on_data_available(dds::DataReader* reader) override {
    Message message;
    dds::SampleInfo info;
    while (reader->take_next_sample(&message, &info) == eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK) {
      if (!info.valid_data) continue;
      const std::lock_guard lock(mutex_);
      last_ = message;
      ++count_;
    }
  }
  int matched() {
    const std::lock_guard lock(mutex_);
    return matched_;
  }
  int count() {
    const std::lock_guard lock(mutex_);
    return count_;
  }
  Message last() {
    const std::lock_guard lock(mutex_);
    return last_;
  }

 private:
  RosNode& node_;
  dds::DataReader* reader_ = nullptr;
  std::mutex mutex_;
  Message last_;
  int matched_ = 0;
  int count_ = 0;
};

}  // namespace s4tp::tests
