#pragma once
/// A subscriber of every topic of a running ECU: when messages came, how large they were, what is missing.

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>

#include <array>
#include <cstdint>
#include <map>
#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim_host/telemetry/dds_publisher.hpp"

namespace s4tp::benchmark {

/// Host time at which the ECU told a record, by the record's vehicle time.
class RecordTimes {
 public:
  void note(std::uint32_t vehicle_ms) {
    const std::lock_guard lock(mutex_);
    told_ns_[vehicle_ms] = dds_time();
  }
  /// \return 0: not known
  [[nodiscard]] dds_time_t at(std::uint32_t vehicle_ms) {
    const std::lock_guard lock(mutex_);
    const auto found = told_ns_.find(vehicle_ms);
    return found == told_ns_.end() ? 0 : found->second;
  }
  [[nodiscard]] std::size_t count() {
    const std::lock_guard lock(mutex_);
    return told_ns_.size();
  }

 private:
  std::mutex mutex_;
  std::map<std::uint32_t, dds_time_t> told_ns_;
};

struct TopicSamples {
  std::vector<double> after_write_us;   ///< from the publisher's write to here
  std::vector<double> after_record_us;  ///< from the ECU's record to here
  std::vector<std::uint32_t> bytes;     ///< serialized
  dds_time_t first_ns = 0;
  dds_time_t last_ns = 0;
};

/// Reliable and keeping ten messages, as ROS 2 does.
class DdsSubscriber {
 public:
  explicit DdsSubscriber(std::uint32_t domain) {
    domain_ = must(dds_create_domain(domain, telemetry::dds_configuration("").c_str()));
    participant_ = must(dds_create_participant(domain, nullptr, nullptr));
    waitset_ = must(dds_create_waitset(participant_));
    dds_qos_t* const qos = dds_create_qos();
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 10);
    for (int i = 0; i < telemetry::kTopicCount; ++i) {
      const auto topic = static_cast<telemetry::Topic>(i);
      const dds_entity_t description =
          must(dds_create_topic(participant_, &telemetry::DdsPublisher::type(topic),
                                telemetry::DdsPublisher::name(topic), nullptr, nullptr));
      readers_[i] = must(dds_create_reader(participant_, description, qos, nullptr));
      (void)must(dds_set_status_mask(readers_[i], DDS_DATA_AVAILABLE_STATUS));
      (void)must(dds_waitset_attach(waitset_, readers_[i], i));
    }
    dds_delete_qos(qos);
  }
  ~DdsSubscriber() {
    dds_delete(participant_);
    dds_delete(domain_);
  }
  DdsSubscriber(const DdsSubscriber&) = delete;
  DdsSubscriber& operator=(const DdsSubscriber&) = delete;

  /// Whether every topic has a publisher.
  [[nodiscard]] bool matched() const {
    for (const dds_entity_t reader : readers_) {
      dds_subscription_matched_status_t status{};
      if (dds_get_subscription_matched_status(reader, &status) != DDS_RETCODE_OK || status.current_count == 0)
        return false;
    }
    return true;
  }

  /// Waits for messages, 100 ms at most, and takes what there is.
  void take(RecordTimes& plans, RecordTimes& commands) {
    (void)dds_waitset_wait(waitset_, nullptr, 0, DDS_MSECS(100));
    for (int i = 0; i < telemetry::kTopicCount; ++i) {
      ddsi_serdata* message = nullptr;
      dds_sample_info_t info;
      while (dds_takecdr(readers_[i], &message, 1, &info, DDS_ANY_STATE) == 1) {
        const dds_time_t now = dds_time();
        if (info.valid_data) {
          RecordTimes* const records = i == telemetry::kTrajectoryTopic ? &plans
                                       : i == telemetry::kControlTopic  ? &commands
                                                                        : nullptr;
          add(samples_[i], *message, info, now, records);
        }
        ddsi_serdata_unref(message);
        message = nullptr;
      }
    }
  }
  [[nodiscard]] const TopicSamples& samples(telemetry::Topic topic) const { return samples_[topic]; }

 private:
  static dds_entity_t must(dds_entity_t entity) {
    if (entity < 0) throw std::runtime_error(std::string("subscriber: ") + dds_strretcode(-entity));
    return entity;
  }

  /// \param records  of a message that begins with its stamp; else null
  static void add(TopicSamples& samples, const ddsi_serdata& message, const dds_sample_info_t& info,
                  dds_time_t now, RecordTimes* records) {
    samples.after_write_us.push_back(static_cast<double>(now - info.source_timestamp) * 1e-3);
    samples.bytes.push_back(ddsi_serdata_size(&message));
    if (samples.first_ns == 0) samples.first_ns = info.source_timestamp;
    samples.last_ns = info.source_timestamp;
    if (records == nullptr) return;
    constexpr std::size_t kEncapsulation = 4;
    std::uint32_t stamp[2];  // seconds and nanoseconds of vehicle time
    ddsi_serdata_to_ser(&message, kEncapsulation, sizeof stamp, stamp);
    const dds_time_t told = records->at(stamp[0] * 1000U + (stamp[1] + 500'000U) / 1'000'000U);
    if (told != 0) samples.after_record_us.push_back(static_cast<double>(now - told) * 1e-3);
  }

  dds_entity_t domain_ = 0;
  dds_entity_t participant_ = 0;
  dds_entity_t waitset_ = 0;
  std::array<dds_entity_t, telemetry::kTopicCount> readers_{};
  std::array<TopicSamples, telemetry::kTopicCount> samples_;
};

}  // namespace s4tp::benchmark
