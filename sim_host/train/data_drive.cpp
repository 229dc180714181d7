#include "sim_host/train/data_drive.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "algo/trajectory/candidates.hpp"
#include "algo/trajectory/driven_lines.hpp"
#include "firmware/ecu/map_conversion.hpp"
#include "firmware/wire/codec.hpp"
#include "sim_host/campaign/driver.hpp"
#include "sim_host/train/branch_driver.hpp"
#include "sim_host/train/branch_tracks.hpp"
#include "sim_host/train/instant.hpp"
#include "sim_host/world/world.hpp"

namespace s4tp::train {
namespace {

constexpr int kTicksPerSnapshot = 10;
constexpr double kBusy_s = 0.9;   // between forks where ways cross or somebody is near
constexpr double kQuiet_s = 4.0;  // and elsewhere
constexpr float kNearM = 30.0F;
constexpr double kLongest_s = 45.0;  // of an episode

traffic::Snapshot snapshot_of(const world::Branch& branch) {
  traffic::Snapshot snapshot;
  snapshot.time_s = branch.time_s();
  snapshot.ego = branch.ego();
  snapshot.ego_steering_rad = branch.vehicle().steering_rad();
  snapshot.others = branch.others();
  return snapshot;
}

/// One of the planner's own candidates from here; false: it has none.
bool draw_candidate(scene::Scene scene, const Parameters& parameters, traffic::Random& random,
                    BranchPlan& plan) {
  plan.start_ms = scene.time_ms + kLeadMs;
  const TrajectoryPoint start =
      trajectory::plan_start(scene.ego, scene.time_ms, {}, plan.start_ms, parameters);
  trajectory::ReferenceLines lines;
  (void)trajectory::build_lines(start, 1e-3F * static_cast<float>(kLeadMs), parameters, scene, lines);
  trajectory::CandidateList candidates;
  int left_out = 0;
  trajectory::generate_candidates(scene, start, {}, plan.start_ms, parameters, kMaxCandidates, lines,
                                  candidates, left_out);
  if (candidates.empty()) return false;
  const trajectory::Candidate& drawn = candidates[random.integer(0, candidates.size() - 1)];
  trajectory::roll_out(lines[drawn.path], drawn, start, {}, plan.start_ms, parameters, plan.candidate);
  return true;
}

/// How often each intention is drawn, in their order.
constexpr double kAtZones[kIntentions] = {3.0, 3.0, 1.5, 1.0, 0.5, 0.5, 2.0};
constexpr double kOnTheRoad[kIntentions] = {2.0, 0.0, 0.0, 3.0, 2.0, 2.0, 2.0};

class DataDrive {
 public:
  DataDrive(const scenario::Scenario& scenario, const DriveOptions& options,
            const std::function<void(const Sample&)>& sink)
      : scenario_(scenario),
        options_(options),
        sink_(sink),
        guide_(scenario::mission_guide(scenario)),
        world_(scenario, world_options(options)),
        driver_(
            campaign::make_driver(options.planner, options.guarded, options.parameters, nullptr, nullptr)),
        observer_(options.parameters),
        random_(traffic::next_seed(options.seed ^ 0xDA7A)) {}

  DriveCounts run();

 private:
  struct Pending {
    Instant instant;
    std::size_t snapshot = 0;  ///< index of its instant in the recording
  };

  static world::WorldOptions world_options(const DriveOptions& options) {
    world::WorldOptions result;
    result.seed = options.seed;
    if (options.noisy) result.perception = scenario::perception_preset("real");
    return result;
  }

  void tick();
  bool observe();
  void consider_fork();
  void fork();
  void branch(Instant instant, int number, const BranchPlan& plan);
  [[nodiscard]] BranchPlan draw(bool at_zone, std::vector<Intention>& used);
  void label(Instant& instant, bool forked);
  void emit(const Sample& sample, bool forked);

  const scenario::Scenario& scenario_;
  const DriveOptions& options_;
  const std::function<void(const Sample&)>& sink_;
  map::RouteGuide guide_;
  world::World world_;
  std::unique_ptr<campaign::Driver> driver_;
  Observer observer_;
  traffic::Random random_;
  std::shared_ptr<const LaneMap> map_;
  std::uint32_t map_revision_ = 0;
  world::EgoCommand command_;  ///< the ECU's last
  double next_fork_s_ = 0.5;
  std::vector<Pending> pending_;
  std::vector<wire::Frame> from_world_;
  std::vector<wire::Frame> from_ecu_;
  DriveCounts counts_;
};

void DataDrive::tick() {
  from_world_.clear();
  from_ecu_.clear();
  world_.tick(from_world_);
  driver_->tick(from_world_, from_ecu_);
  for (const wire::Frame& frame : from_ecu_) {
    world_.receive(frame);
    wire::Command command;
    if (frame.id == wire::kCommandId && wire::decode(frame, command)) {
      command_ = {static_cast<double>(command.acceleration_mps2), static_cast<double>(command.steering_rad)};
    }
  }
}

bool DataDrive::observe() {
  const ecu::Inputs& inputs = driver_->core().inputs();
  if (!inputs.ego_known() || inputs.map() == nullptr) return false;
  if (!map_ || inputs.map_revision() != map_revision_) {
    auto map = std::make_shared<LaneMap>();
    ecu::convert(*inputs.map(), *map);
    map_ = std::move(map);
    map_revision_ = inputs.map_revision();
  }
  return observer_.look(inputs.now_ms(), inputs.ego(), inputs.tracks(), inputs.tracks_ms(), *map_);
}

BranchPlan DataDrive::draw(bool at_zone, std::vector<Intention>& used) {
  const double(&weights)[kIntentions] = at_zone ? kAtZones : kOnTheRoad;
  const scene::EgoPath& keep = observer_.scene().ego_paths[0];
  const auto weight = [&](int i) {
    const auto intention = static_cast<Intention>(i);
    if (std::find(used.begin(), used.end(), intention) != used.end()) return 0.0;
    const Lane& lane = map_->lanes[keep.path.lanes[0].lane];
    if (intention == Intention::kLeft && lane.left == kNoLaneIndex) return 0.0;
    if (intention == Intention::kRight && lane.right == kNoLaneIndex) return 0.0;
    return weights[i];
  };
  double total = 0.0;
  for (int i = 0; i < kIntentions; ++i) total += weight(i);
  double left = random_.uniform(0.0, total);
  int drawn = 0;
  for (int i = 0; i < kIntentions; ++i) {
    if (weight(i) <= 0.0) continue;
    drawn = i;
    left -= weight(i);
    if (left < 0.0) break;
  }
  const auto intention = static_cast<Intention>(drawn);
  used.push_back(intention);
  BranchPlan plan = draw_plan(intention, random_);
  if (intention == Intention::kCandidate &&
      !draw_candidate(observer_.scene(), options_.parameters, random_, plan)) {
    plan.intention = Intention::kGo;
  }
  return plan;
}

void DataDrive::label(Instant& instant, bool forked) {
  Sample& sample = instant.sample;
  sample.road = options_.road;
  sample.episode = static_cast<std::uint16_t>(options_.seed);
  sample.scenario = options_.scenario;
  sample.flags = static_cast<std::uint8_t>((forked ? kForked : 0) | (options_.reporting ? kReporting : 0));
}

void DataDrive::emit(const Sample& sample, bool forked) {
  ++counts_.samples;
  counts_.forked += forked ? 1 : 0;
  sink_(sample);
}

void DataDrive::branch(Instant instant, int number, const BranchPlan& plan) {
  BranchDriver ego(
      {command_, static_cast<double>(kLeadS), instant.scene.time_ms, world_.origin(), &options_.parameters},
      plan);
  const std::unique_ptr<world::Branch> branch = world_.fork(ego);
  Observer observer = observer_;
  BranchTracks tracks(world_options(options_).perception, world_.origin(), random_.integer(0, 1 << 30));
  tracks.adopt(observer.scene(), branch->others());
  const std::size_t later[] = {static_cast<std::size_t>(random_.integer(8, 24)),
                               static_cast<std::size_t>(random_.integer(25, 48))};
  std::vector<traffic::Snapshot> drive{snapshot_of(*branch)};
  std::vector<Pending> instants;
  while (drive.size() < kSettledSnapshots) {
    for (int tick = 0; tick < kTicksPerSnapshot; ++tick) branch->step();
    drive.push_back(snapshot_of(*branch));
    const std::size_t index = drive.size() - 1;
    if (index > later[1] || branch->touched() != traffic::kNoCar) continue;  // who has touched is no example
    const bool seen = observer.look(instant.scene.time_ms + static_cast<std::uint32_t>(100 * index),
                                    ego_state_of(branch->vehicle(), world_.origin()),
                                    tracks.of(branch->ego(), branch->others()),
                                    instant.scene.time_ms + static_cast<std::uint32_t>(100 * index), *map_);
    if (!seen || (index != later[0] && index != later[1])) continue;
    Instant there = capture(observer, options_.parameters, map_, branch->others(), world_.origin());
    if (there.sample.input.hdvs > 0) instants.push_back({std::move(there), index});
  }
  counts_.driven_s += 0.1 * static_cast<double>(kSettledSnapshots);
  ++counts_.branches;
  counts_.collided += branch->touched() != traffic::kNoCar ? 1 : 0;
  label(instant, true);
  instant.sample.branch = static_cast<std::uint8_t>(number);
  complete(instant, scenario_, guide_, drive, branch->touched(), world_.origin(), options_.parameters);
  emit(instant.sample, true);
  for (std::size_t i = 0; i < instants.size(); ++i) {
    Instant& there = instants[i].instant;
    label(there, false);
    there.sample.fork = instant.sample.fork + 16 * static_cast<std::uint64_t>(number) + i + 1;
    there.sample.branch = static_cast<std::uint8_t>(number);
    complete(there, scenario_, guide_, std::span(drive).subspan(instants[i].snapshot), branch->touched(),
             world_.origin(), options_.parameters);
    emit(there.sample, false);
  }
}

void DataDrive::fork() {
  Instant instant = capture(observer_, options_.parameters, map_, world_.recording().snapshots.back().others,
                            world_.origin());
  if (instant.sample.input.hdvs == 0) return;
  const std::uint64_t key =
      (options_.road * 100'000 + options_.seed) * 1000 + static_cast<std::uint64_t>(counts_.forks);
  instant.sample.fork = key * 256;
  ++counts_.forks;
  bool at_zone = false;
  for (int i = 0; i < instant.sample.input.hdvs; ++i) {
    at_zone = at_zone || instant.sample.input.pair[i][static_cast<int>(satp::PairFeature::kZone)] > 0.5F;
  }
  std::vector<Intention> used;
  for (int i = 1; i <= options_.branches; ++i) branch(instant, i, draw(at_zone, used));
  label(instant, true);
  pending_.push_back({std::move(instant), world_.recording().snapshots.size() - 1});
}

void DataDrive::consider_fork() {
  if (world_.time_s() < next_fork_s_ || counts_.forks >= options_.forks) return;
  const scene::Scene& scene = observer_.scene();
  bool busy = false;
  for (int i = 0; i < scene.watched; ++i) {
    const Track& track = scene.agents[i].track;
    busy = busy || distance(position(track.centre), position(scene.ego.rear_axle)) < kNearM;
  }
  fork();
  next_fork_s_ = world_.time_s() + (busy ? kBusy_s : kQuiet_s) * random_.uniform(0.7, 1.6);
}

DriveCounts DataDrive::run() {
  bool whole = true;
  while (!world_.finished() && world_.time_s() < kLongest_s && whole) {
    tick();
    const bool boundary = driver_->core().now_ms() % 100 == 0;
    if (!boundary) continue;
    const bool seen = observe();
    if (seen && world_.time_s() >= 0.0 && !world_.finished() && world_.recording().collisions.empty()) {
      consider_fork();
    }
    // What comes after the last fork is driven only as far as its sample needs it.
    whole = counts_.forks < options_.forks ||
            world_.recording().snapshots.size() < pending_.back().snapshot + kSettledSnapshots;
  }
  counts_.driven_s += world_.time_s();
  const traffic::Recording& recording = world_.recording();
  const int touched = recording.collisions.empty() ? traffic::kNoCar : recording.collisions.front().other;
  for (Pending& one : pending_) {
    const std::span<const traffic::Snapshot> drive = std::span(recording.snapshots).subspan(one.snapshot);
    if (drive.size() < kSampleSnapshots) continue;
    const bool in_time =
        touched != traffic::kNoCar &&
        recording.collisions.front().time_s <= drive[std::min(drive.size(), kSettledSnapshots) - 1].time_s;
    complete(one.instant, scenario_, guide_, drive, in_time ? touched : traffic::kNoCar, world_.origin(),
             options_.parameters);
    emit(one.instant.sample, true);
  }
  return counts_;
}

}  // namespace

DriveCounts& DriveCounts::operator+=(const DriveCounts& other) {
  forks += other.forks;
  branches += other.branches;
  collided += other.collided;
  samples += other.samples;
  forked += other.forked;
  driven_s += other.driven_s;
  return *this;
}

DriveCounts make_samples(const scenario::Scenario& scenario, const DriveOptions& options,
                         const std::function<void(const Sample&)>& sink) {
  return DataDrive(scenario, options, sink).run();
}

}  // namespace s4tp::train
