#include "sim_host/campaign/reference_drive.hpp"

#include <stdexcept>

#include "firmware/wire/codec.hpp"

namespace s4tp::campaign {
namespace {

constexpr double kStandingMps = 0.1;
constexpr double kDrivingMps = 2.0;
constexpr double kBlindFromS =
    1.0;  // perception is lost for 0.6 s: stale after 0.3 s, back before it counts as lost
constexpr double kBlindUntilS = 1.6;
constexpr double kDeadlineMissS = 3.0;

bool is_perception(const wire::Frame& frame) {
  return frame.id == wire::kTrackListId || frame.id == wire::kTrackPoseId || frame.id == wire::kTrackMotionId;
}

}  // namespace

DriveContent content_of(const EpisodeResult& result) {
  DriveContent content;
  for (const traffic::Snapshot& snapshot : result.recording.snapshots) {
    if (snapshot.time_s < 0.0) continue;
    content.stopped = content.stopped || snapshot.ego.speed_mps < kStandingMps;
    content.restarted = content.restarted || (content.stopped && snapshot.ego.speed_mps > kDrivingMps);
  }
  for (const CycleTrace& cycle : result.trace->cycles) {
    const trajectory::Candidate& chosen = cycle.record.explanation.chosen;
    const bool sideways = chosen.path != 0 && cycle.record.plan.kind == PlanKind::kDrive;
    content.changed_lane = content.changed_lane || sideways;
  }
  for (const ecu::ModeRecord& change : result.trace->modes) {
    content.degraded = content.degraded || change.to == ecu::Mode::kDegraded;
    content.recovered =
        content.recovered || (change.from == ecu::Mode::kDegraded && change.to == ecu::Mode::kDriving);
  }
  return content;
}

std::uint64_t record_reference_drive(const scenario::Scenario& left_turn, const std::filesystem::path& file) {
  constexpr std::uint64_t kSeeds = 50;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    EpisodeOptions options;
    options.seed = seed;
    options.trace = true;
    options.log = file;
    options.passes = [](double time_s, const wire::Frame& frame) {
      return !(is_perception(frame) && time_s >= kBlindFromS && time_s < kBlindUntilS);
    };
    options.deadline_misses_s = {kDeadlineMissS};
    const EpisodeResult result = run_episode(left_turn, options);
    if (result.recording.ending == traffic::Ending::kGoal && content_of(result).complete()) return seed;
  }
  throw std::runtime_error(
      "no left turn of seeds 0 to 49 has a stop, a restart, a lane change and a degraded mode");
}

}  // namespace s4tp::campaign
