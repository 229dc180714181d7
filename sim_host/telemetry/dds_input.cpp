#include "sim_host/telemetry/dds_input.hpp"

#include <stdexcept>
#include <string>

#include "firmware/can/frames.hpp"

namespace s4tp::telemetry {
namespace {

constexpr int kMostSamples = 32;
constexpr int kListFrames = 12;
constexpr int kMapFrames = 7;
constexpr std::uint32_t kTellEveryMs = 1000;

/// A full queue is counted by the bus; the list is then broken and refused.
void pass_on(const wire::Frame& frame, hal::Can& can) {
  (void)can.send(to_hal(frame));
}

}  // namespace

DdsInput::DdsInput(dds_entity_t participant, std::ostream& complaints) : complaints_(complaints) {
  open(participant, autoware_perception_msgs_msg_dds__TrackedObjects__desc, objects_);
  open(participant, s4tp_msgs_msg_dds__LaneMap__desc, maps_);
}

void DdsInput::open(dds_entity_t participant, const dds_topic_descriptor_t& type, Topic& topic) {
  dds_qos_t* const qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_MSECS(10));
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, kMostSamples);
  dds_data_representation_id_t xcdr1 = DDS_DATA_REPRESENTATION_XCDR1;
  dds_qset_data_representation(qos, 1, &xcdr1);
  const dds_entity_t entity = dds_create_topic(participant, &type, topic.name, nullptr, nullptr);
  topic.reader = entity < 0 ? entity : dds_create_reader(participant, entity, qos, nullptr);
  dds_delete_qos(qos);
  if (topic.reader < 0)
    throw std::runtime_error(std::string(topic.name) + ": " + dds_strretcode(-topic.reader));
}

template <class Message, class Take>
void DdsInput::take(Topic& topic, InputCounts& counts, std::uint32_t now_ms, Take take_one) {
  void* samples[kMostSamples] = {};
  dds_sample_info_t infos[kMostSamples];
  const int count = dds_take(topic.reader, samples, infos, kMostSamples, kMostSamples);
  for (int i = 0; i < count; ++i) {
    if (!infos[i].valid_data) continue;
    Refusal refusal = Refusal::kTooOften;
    if (topic.rate.admits(now_ms)) refusal = take_one(*static_cast<const Message*>(samples[i]));
    ++counts.by[static_cast<int>(refusal)];
    if (refusal == Refusal::kNone || (topic.told && now_ms - topic.told_ms < kTellEveryMs)) continue;
    topic.told = true;
    topic.told_ms = now_ms;
    complaints_ << topic.name << ": a message was refused: " << refusal_text(refusal) << " ("
                << counts.refused() << " refused, " << counts.taken() << " taken)" << std::endl;
  }
  if (count > 0) (void)dds_return_loan(topic.reader, samples, count);
}

void DdsInput::look(std::uint32_t now_ms) {
  using Objects = autoware_perception_msgs_msg_dds__TrackedObjects_;
  take<Objects>(objects_, report_.objects, now_ms, [&](const Objects& message) {
    wire::Tracks tracks;
    const Refusal refusal = to_tracks(message, ids_, tracks);
    if (refusal == Refusal::kNone) track_sender_.start(tracks);
    return refusal;
  });
  take<LaneMapMessage>(maps_, report_.maps, now_ms, [&](const LaneMapMessage& message) {
    const Refusal refusal = to_map(message, map_);
    if (refusal != Refusal::kNone) return refusal;
    map_sender_.update(map_);
    map_ms_ = now_ms;
    map_known_ = true;
    return refusal;
  });
}

void DdsInput::send(std::uint32_t now_ms, hal::Can& can) {
  wire::Frame frame;
  for (int i = 0; i < kListFrames && track_sender_.next(frame); ++i) pass_on(frame, can);
  if (!map_known_ || now_ms - map_ms_ > kMapStandsMs) return;
  for (int i = 0; i < kMapFrames && map_sender_.next(now_ms, frame); ++i) pass_on(frame, can);
}

}  // namespace s4tp::telemetry
