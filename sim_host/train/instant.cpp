#include "sim_host/train/instant.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "algo/satp/input_builder.hpp"
#include "sim_host/world/nodes/vehicle.hpp"
#include "sim_host/world/traffic/traffic_view.hpp"

namespace s4tp::train {
namespace {

constexpr double kSame_m = 3.0;  // from a track to the car it is
constexpr double kGoesWithin_s = 4.0;
constexpr double kStands_mps = 0.5;
constexpr float kOnPathM = 2.0F;

Pose odometry(const traffic::CarState& car, map::Vec2 origin) {
  return {static_cast<float>(car.centre.x - origin.x), static_cast<float>(car.centre.y - origin.y),
          static_cast<float>(car.heading_rad)};
}

const traffic::CarState* find(const std::vector<traffic::CarState>& cars, int id) {
  const auto car =
      std::find_if(cars.begin(), cars.end(), [&](const traffic::CarState& one) { return one.id == id; });
  return car == cars.end() ? nullptr : &*car;
}

Trajectory driven(std::span<const traffic::Snapshot> drive, map::Vec2 origin, const Parameters& parameters) {
  Trajectory plan;
  const float to_centre_m = 0.5F * parameters.vehicle.length_m - parameters.vehicle.rear_overhang_m;
  for (int i = 0; i < kTrajectoryPoints; ++i) {
    const traffic::Snapshot& snapshot = drive[kLeadSnapshots + static_cast<std::size_t>(i)];
    plan.points[i].rear_axle = shift_ahead(odometry(snapshot.ego, origin), -to_centre_m);
    plan.points[i].speed_mps = static_cast<float>(snapshot.ego.speed_mps);
    plan.points[i].acceleration_mps2 = static_cast<float>(snapshot.ego.acceleration_mps2);
    plan.points[i].curvature_1pm =
        static_cast<float>(std::tan(snapshot.ego_steering_rad)) / parameters.vehicle.wheelbase_m;
  }
  return plan;
}

std::int8_t route_of(const Instant& instant, int agent, const Pose& at_horizon) {
  const scene::Agent& watched = instant.scene.agents[agent];
  std::int8_t best = -1;
  float nearest_m = kOnPathM;
  for (int k = 0; k < watched.paths.size(); ++k) {
    const float guess_m = watched.frenet[k].s_m + kHorizonS * watched.track.speed_mps;
    const scene::Frenet at =
        scene::project(*instant.map, watched.paths[k], position(at_horizon), guess_m, -1.0F);
    if (std::abs(at.d_m) < nearest_m) {
      nearest_m = std::abs(at.d_m);
      best = static_cast<std::int8_t>(k);
    }
  }
  return best;
}

/// Whether the ego came to the zone soon and without waiting.
bool went(std::span<const traffic::Snapshot> drive, double entry_s) {
  const double start_s = drive[kLeadSnapshots].time_s;
  if (entry_s > start_s + kGoesWithin_s) return false;
  bool has_moved = false;
  for (const traffic::Snapshot& snapshot : drive.subspan(kLeadSnapshots)) {
    if (snapshot.time_s > entry_s) break;
    if (has_moved && snapshot.ego.speed_mps < kStands_mps) return false;
    has_moved = has_moved || snapshot.ego.speed_mps >= kStands_mps;
  }
  return true;
}

}  // namespace

Instant capture(const Observer& observer, const Parameters& parameters, std::shared_ptr<const LaneMap> map,
                const std::vector<traffic::CarState>& others, map::Vec2 origin) {
  Instant instant;
  instant.map = std::move(map);
  instant.scene = observer.scene();
  instant.scene.map = instant.map.get();
  instant.sample.time_ms = instant.scene.time_ms;
  satp::build_network_input(instant.scene, parameters, kLeadS, instant.sample.input);
  observer.expect(instant.sample.input, instant.sample.kinematic);
  for (int i = 0; i < kMaxAgents; ++i) {
    instant.car[i] = traffic::kNoCar;
    if (i >= instant.scene.watched) continue;
    const Pose& seen = instant.scene.agents[i].track.centre;
    double nearest_m = kSame_m;
    for (const traffic::CarState& car : others) {
      const Pose there = odometry(car, origin);
      const double distance_m = std::hypot(there.x_m - seen.x_m, there.y_m - seen.y_m);
      if (distance_m >= nearest_m) continue;
      nearest_m = distance_m;
      instant.car[i] = car.id;
    }
  }
  return instant;
}

void complete(Instant& instant, const scenario::Scenario& scenario, const map::RouteGuide& guide,
              std::span<const traffic::Snapshot> drive, int touched, map::Vec2 origin,
              const Parameters& parameters) {
  drive = drive.first(std::min(drive.size(), kSettledSnapshots));
  Sample& sample = instant.sample;
  satp::build_plan_input(driven(drive, origin, parameters), parameters, sample.input, sample.plan);
  const Meetings meetings(scenario.network, guide, drive);
  bool unsettled = false;
  double entry_s = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kMaxAgents; ++i) {
    sample.yields[i] = sample.route[i] = -1;
    if (instant.car[i] == traffic::kNoCar) continue;
    for (int step = 0; step < kHorizonSteps; ++step) {
      const traffic::CarState* car =
          find(drive[kLeadSnapshots + 1 + static_cast<std::size_t>(step)].others, instant.car[i]);
      if (car == nullptr) break;  // who has left the network does not come back
      const Pose truth = odometry(*car, origin);
      const Pose local = satp::to_anchor(sample.input.anchor[i], truth);
      sample.target.pose[i][step][0] = local.x_m;
      sample.target.pose[i][step][1] = local.y_m;
      sample.target.pose[i][step][2] = local.heading_rad;
      sample.target.valid[i] |= std::uint32_t{1} << step;
      if (step == kHorizonSteps - 1) sample.route[i] = route_of(instant, i, truth);
    }
    const Meeting meeting = meetings.with(instant.car[i]);
    sample.interacts[i] = meeting.shares ? 1 : 0;
    sample.rule[i] = meeting.rule;
    sample.yields[i] = instant.car[i] == touched ? std::int8_t{0} : meeting.yields;
    unsettled = unsettled || (meeting.rule != SampleRule::kNoZone && sample.yields[i] < 0);
    entry_s = std::min(entry_s, meeting.entry_s);
  }
  sample.flags = static_cast<std::uint8_t>(
      (sample.flags & (kForked | kReporting)) | (touched != traffic::kNoCar ? kCollided : 0) |
      (unsettled ? kUnsettled : 0) | (went(drive, entry_s) ? kEgoGoes : 0));
}

}  // namespace s4tp::train
