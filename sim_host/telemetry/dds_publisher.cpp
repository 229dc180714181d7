#include "sim_host/telemetry/dds_publisher.hpp"

#include <cstdlib>
#include <stdexcept>

#include "sim_host/telemetry/dds_messages.hpp"
#include "sim_host/view/plan_numbers.hpp"
#include "sim_host/view/plan_words.hpp"

namespace s4tp::telemetry {
namespace {

constexpr std::uint32_t kSlowMs = 1000;
constexpr std::chrono::seconds kInputToldEvery{
    1};  // of this machine: without an ECU there is no vehicle time

struct TopicSpec {
  const char* name;
  const dds_topic_descriptor_t* type;
  bool kept;  ///< for late joiners
  int depth;
};

const TopicSpec kTopics[kTopicCount] = {
    {"rt/s4tp/tracked_objects", &autoware_perception_msgs_msg_dds__TrackedObjects__desc, false, 1},
    {"rt/s4tp/predicted_objects", &autoware_perception_msgs_msg_dds__PredictedObjects__desc, false, 1},
    {"rt/s4tp/trajectory", &autoware_planning_msgs_msg_dds__Trajectory__desc, true, 1},
    {"rt/s4tp/fail_safe", &autoware_planning_msgs_msg_dds__Trajectory__desc, true, 1},
    {"rt/s4tp/candidates", &visualization_msgs_msg_dds__MarkerArray__desc, true, 1},
    {"rt/s4tp/control", &autoware_control_msgs_msg_dds__Control__desc, false, 1},
    {"rt/s4tp/risk", &nav_msgs_msg_dds__OccupancyGrid__desc, true, 1},
    {"rt/s4tp/path", &nav_msgs_msg_dds__Path__desc, true, 1},
    {"rt/s4tp/lanes", &visualization_msgs_msg_dds__MarkerArray__desc, true, 1},
    {"rt/s4tp/explanation", &std_msgs_msg_dds__String__desc, true, 1},
    {"rt/diagnostics", &diagnostic_msgs_msg_dds__DiagnosticArray__desc, true, 1},
    {"rt/tf", &tf2_msgs_msg_dds__TFMessage__desc, false, 10},
};

dds_entity_t must(dds_entity_t entity, const char* what) {
  if (entity < 0) throw std::runtime_error(std::string(what) + ": " + dds_strretcode(-entity));
  return entity;
}

}  // namespace

std::string dds_configuration(const std::string& interface_name) {
  if (const char* own = std::getenv("CYCLONEDDS_URI"); own != nullptr && *own != '\0') return own;
  // Multicast is often missing on loopback: everybody is asked there one by one.
  const bool local = interface_name.empty() || interface_name == "lo";
  const std::string name = local ? "lo" : interface_name;
  return "<General><Interfaces><NetworkInterface name=\"" + name + "\"" +
         (local ? " multicast=\"false\"" : "") + "/></Interfaces>" +
         (local ? "<AllowMulticast>false</AllowMulticast>" : "") +
         "</General><Discovery><ParticipantIndex>auto</ParticipantIndex>"
         "<MaxAutoParticipantIndex>120</MaxAutoParticipantIndex>" +
         (local ? "<Peers><Peer address=\"127.0.0.1\"/></Peers>" : "") + "</Discovery>";
}

const char* DdsPublisher::name(Topic topic) {
  return kTopics[topic].name;
}

const dds_topic_descriptor_t& DdsPublisher::type(Topic topic) {
  return *kTopics[topic].type;
}

DdsPublisher::DdsPublisher(std::uint32_t domain, const std::string& interface_name) {
  domain_ = must(dds_create_domain(domain, dds_configuration(interface_name).c_str()), "DDS domain");
  participant_ = must(dds_create_participant(domain, nullptr, nullptr), "DDS participant");
  for (int i = 0; i < kTopicCount; ++i) {
    const TopicSpec& spec = kTopics[i];
    dds_qos_t* const qos = dds_create_qos();
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_MSECS(10));
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, spec.depth);
    dds_qset_durability(qos, spec.kept ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
    if (spec.kept) {
      dds_qset_durability_service(qos, 0, DDS_HISTORY_KEEP_LAST, spec.depth, DDS_LENGTH_UNLIMITED,
                                  DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
    }
    dds_data_representation_id_t xcdr1 = DDS_DATA_REPRESENTATION_XCDR1;
    dds_qset_data_representation(qos, 1, &xcdr1);
    const dds_entity_t topic = dds_create_topic(participant_, spec.type, spec.name, qos, nullptr);
    writers_[i] = topic < 0 ? topic : dds_create_writer(participant_, topic, qos, nullptr);
    dds_delete_qos(qos);
    (void)must(writers_[i], spec.name);
  }
}

DdsPublisher::~DdsPublisher() {
  dds_delete(participant_);
  dds_delete(domain_);
}

template <class Message>
void DdsPublisher::write(Topic topic, const Message& message) {
  if (dds_write(writers_[topic], &message) == DDS_RETCODE_OK) ++written_[topic];
}

bool DdsPublisher::anybody(Topic topic) const {
  dds_publication_matched_status_t status{};
  return dds_get_publication_matched_status(writers_[topic], &status) == DDS_RETCODE_OK &&
         status.current_count > 0;
}

void DdsPublisher::publish(const Watch& watch, const News& news, const InputReport* input) {
  if (news.another_ecu) lanes_told_ = diagnosed_ = false;
  if (news.plan) publish_plan(watch);
  const bool due = watch.control().time_ms - diagnostics_ms_ >= kSlowMs || !diagnosed_;
  if (news.control && (due || !news.mode_changes.empty())) {
    Arena arena;
    write(kDiagnosticsTopic, diagnostics(watch.control(), watch.status(), watch.cycle(), input, arena));
    diagnostics_ms_ = watch.control().time_ms;
    diagnosed_ = true;
  }
  if (input == nullptr || watch.present()) return;
  const auto now = std::chrono::steady_clock::now();
  if (now - input_told_ < kInputToldEvery) return;
  input_told_ = now;
  Arena arena;
  write(kDiagnosticsTopic, diagnostics(*input, arena));
}

void DdsPublisher::publish(const ecu::ControlRecord& record) {
  write(kControlTopic, control(record));
}

void DdsPublisher::publish_plan(const Watch& watch) {
  Arena arena;
  const ecu::PlanRecord& plan = watch.plan();
  const Parameters& parameters = watch.identity().parameters;
  write(kTrajectoryTopic, trajectory(plan.plan, parameters.vehicle.wheelbase_m, arena));
  write(kPathTopic, path(plan.plan, arena));
  std_msgs_msg_dds__String_ words{};
  const campaign::CycleTrace trace = trace_of(plan, watch.cycle(), watch.ecu());
  words.data = arena.text(view::in_words(trace) + "\n" + view::in_numbers(trace));
  write(kExplanationTopic, words);
  if (watch.cycle() == nullptr) return;
  const CycleRecord& cycle = *watch.cycle();
  write(kTransformTopic, transform(cycle, arena));
  write(kTrackedTopic, tracked_objects(cycle, arena));
  write(kPredictedTopic, predicted_objects(plan, cycle, arena));
  write(kFailSafeTopic, trajectory(fail_safe_of(plan, parameters), parameters.vehicle.wheelbase_m, arena));
  write(kCandidatesTopic, candidate_markers(plan, candidates_of(plan, cycle, parameters), arena));
  if (!lanes_told_ || plan.plan.start_ms - lanes_ms_ >= kSlowMs) {
    write(kLanesTopic, lane_markers(cycle, arena));
    lanes_ms_ = plan.plan.start_ms;
    lanes_told_ = true;
  }
  if (anybody(kRiskTopic)) write(kRiskTopic, risk_grid(heat_map_of(plan, cycle, parameters), cycle, arena));
}

}  // namespace s4tp::telemetry
