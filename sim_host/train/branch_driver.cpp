#include "sim_host/train/branch_driver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim_host/world/traffic/box.hpp"
#include "sim_host/world/traffic/traffic_driver.hpp"

namespace s4tp::train {
namespace {

constexpr double kTick_s = 0.01;
constexpr int kDecisionTicks = 10;
constexpr double kSight_m = 80.0;
constexpr double kSideways_mps2 = 2.5;  // in bends
constexpr double kSlowing_mps2 = 2.0;   // towards bends and lower limits
constexpr double kHardest_mps2 = 8.0;
constexpr double kRoom_m = 1.0;    // left before a zone
constexpr double kBeside_m = 0.4;  // spare sideways: who is nearer is in the way
constexpr double kStanding_mps = 0.3;
constexpr double kHorizon_s = static_cast<double>(kHorizonSteps) * static_cast<double>(kStepS);
constexpr double kNever = std::numeric_limits<double>::infinity();

const map::Lane& lane_of(const world::Branch& now, map::LaneId lane) {
  return now.road().scenario.network.lanes[static_cast<std::size_t>(lane)];
}

double smooth(double p) {
  p = std::clamp(p, 0.0, 1.0);
  return p * p * p * (10.0 - 15.0 * p + 6.0 * p * p);
}

}  // namespace

BranchPlan draw_plan(Intention intention, traffic::Random& random) {
  BranchPlan plan;
  plan.intention = intention;
  plan.acceleration_mps2 = random.uniform(0.8, 3.2);
  plan.braking_mps2 = random.uniform(1.0, 5.0);
  plan.limit_share = random.uniform(0.6, 1.1);
  plan.slow_share = random.uniform() < 0.3 ? 0.0 : random.uniform(0.0, 0.8);
  plan.wait_s = random.uniform(0.3, 8.0);
  plan.creep_mps = random.uniform(0.6, 2.5);
  plan.change_s = random.uniform(2.5, 5.0);
  plan.reckless = random.uniform() < 0.1;
  return plan;
}

EgoState ego_state_of(const nodes::Vehicle& vehicle, map::Vec2 origin) {
  EgoState ego;
  const map::Vec2 axle = vehicle.rear_axle();
  ego.rear_axle = {static_cast<float>(axle.x - origin.x), static_cast<float>(axle.y - origin.y),
                   static_cast<float>(vehicle.heading_rad())};
  ego.speed_mps = static_cast<float>(vehicle.speed_mps());
  ego.acceleration_mps2 = static_cast<float>(std::clamp(vehicle.acceleration_mps2(), -12.0, 12.0));
  ego.yaw_rate_radps = static_cast<float>(std::clamp(vehicle.yaw_rate_radps(), -2.0, 2.0));
  ego.steering_rad = static_cast<float>(vehicle.steering_rad());
  return ego;
}

void BranchDriver::begin(const world::Branch& now) {
  lane_ = now.place().lane;
  if (lane_ == map::kNoLane) return;
  const map::Lane& here = lane_of(now, lane_);
  const bool changes = plan_.intention == Intention::kLeft || plan_.intention == Intention::kRight;
  const map::LaneId beside = plan_.intention == Intention::kLeft ? here.left : here.right;
  if (changes && beside != map::kNoLane) lane_ = beside;
  const map::PolylineProjection at = lane_of(now, lane_).centre.project(now.ego().centre);
  s_m_ = at.s_m;
  offset_m_ = at.d_m;
  brake_to_mps_ = plan_.slow_share * now.ego().speed_mps;
  tracker_.reset(static_cast<float>(now.ego().acceleration_mps2));
}

void BranchDriver::advance(const world::Branch& now) {
  s_m_ = lane_of(now, lane_).centre.project(now.ego().centre).s_m;
  const map::LaneId next = next_of(now, lane_);
  if (s_m_ >= lane_of(now, lane_).centre.length_m() && next != map::kNoLane) {
    lane_ = next;
    s_m_ = lane_of(now, lane_).centre.project(now.ego().centre).s_m;
  }
}

map::LaneId BranchDriver::next_of(const world::Branch& now, map::LaneId lane) const {
  const map::LaneId next = now.road().guide.advice(lane).next;
  if (next != map::kNoLane) return next;
  const auto& successors = lane_of(now, lane).successors;
  return successors.empty() ? map::kNoLane : successors.front();
}

std::vector<BranchDriver::Part> BranchDriver::way_ahead(const world::Branch& now) const {
  std::vector<Part> way;
  double start_m = -s_m_;
  for (map::LaneId lane = lane_; lane != map::kNoLane && start_m < kSight_m && way.size() < 12;
       lane = next_of(now, lane)) {
    way.push_back({lane, start_m});
    start_m += lane_of(now, lane).centre.length_m();
  }
  return way;
}

double BranchDriver::wanted_mps(const world::Branch& now, const std::vector<Part>& way) const {
  double wanted = kNever;
  const auto slow_for = [&](double speed_mps, double ahead_m) {
    wanted =
        std::min(wanted, std::sqrt(speed_mps * speed_mps + 2.0 * kSlowing_mps2 * std::max(0.0, ahead_m)));
  };
  for (const Part& part : way) {
    const map::Lane& lane = lane_of(now, part.lane);
    slow_for(lane.speed_limit_mps * plan_.limit_share, part.start_m);
    for (double s = std::max(0.0, -part.start_m); s < lane.centre.length_m() && part.start_m + s < 40.0;
         s += 3.0) {
      const double curvature = std::abs(lane.centre.at(s).curvature_1pm);
      slow_for(std::sqrt(kSideways_mps2 / std::max(curvature, 1e-3)), part.start_m + s);
    }
  }
  const map::Lane& last = lane_of(now, way.back().lane);
  const bool dead_end = last.successors.empty() && last.edge != now.road().scenario.mission.edges.back();
  if (dead_end) slow_for(0.0, way.back().start_m + last.centre.length_m() - 5.0);
  return wanted;
}

double BranchDriver::behind_leader_mps2(const world::Branch& now, const std::vector<Part>& way,
                                        double wanted) const {
  traffic::Driver driver;
  driver.acceleration_mps2 = plan_.acceleration_mps2;
  double result = traffic::free_acceleration_mps2(driver, now.ego().speed_mps, wanted);
  if (plan_.reckless) return result;
  for (const traffic::CarState& car : now.others()) {
    if (std::hypot(car.centre.x - now.ego().centre.x, car.centre.y - now.ego().centre.y) > kSight_m) continue;
    for (const Part& part : way) {
      const map::Polyline& centre = lane_of(now, part.lane).centre;
      const map::PolylineProjection at = centre.project(car.centre);
      const double turned = map::wrap_angle(centre.at(at.s_m).heading_rad - car.heading_rad);
      const double gap_m = part.start_m + at.s_m - 0.5 * (car.length_m + now.ego().length_m);
      const bool on_it = at.s_m >= 0.0 && at.s_m <= centre.length_m() && std::abs(turned) < 0.8 &&
                         std::abs(at.d_m) < 0.5 * (car.width_m + now.ego().width_m) + kBeside_m;
      if (!on_it || gap_m < -0.5 * now.ego().length_m) continue;
      result = std::min(result, traffic::following_acceleration_mps2(driver, now.ego().speed_mps, wanted,
                                                                     gap_m, car.speed_mps));
    }
  }
  return result;
}

BranchDriver::Zone BranchDriver::next_zone(const world::Branch& now, const std::vector<Part>& way) {
  Zone nearest;
  for (const Part& part : way) {
    for (const map::Conflict& conflict : now.road().scenario.network.conflicts) {
      const bool first = conflict.first == part.lane;
      if (!first && conflict.second != part.lane) continue;
      const double entry_m = part.start_m + (first ? conflict.first_entry_m : conflict.second_entry_m);
      const double exit_m = part.start_m + (first ? conflict.first_exit_m : conflict.second_exit_m);
      const double wait_m = entry_m - kRoom_m;
      if (wait_m > 0.0 && wait_m < nearest.wait_m) nearest.wait_m = wait_m;
      nearest.inside = nearest.inside || (wait_m <= 0.0 && exit_m > 0.0);
    }
  }
  return nearest;
}

double BranchDriver::choose_mps2(const world::Branch& now, const std::vector<Part>& way) {
  const double speed = now.ego().speed_mps;
  double wanted = wanted_mps(now, way);
  const Zone zone = next_zone(now, way);
  const double stops_in_m = speed * speed / (2.0 * kHardest_mps2);
  const bool waits = !released_ && zone.wait_m < kNever && zone.wait_m > stops_in_m;
  double limit = kNever;
  switch (plan_.intention) {
    case Intention::kYield:
      if (!waits) break;
      limit = traffic::stopping_acceleration_mps2({}, speed, wanted, zone.wait_m);
      stood_s_ += speed < kStanding_mps ? kTick_s * kDecisionTicks : 0.0;
      released_ = stood_s_ > plan_.wait_s;
      break;
    case Intention::kCreep:
      wanted =
          std::min(wanted, zone.inside ? plan_.creep_mps
                                       : std::sqrt(plan_.creep_mps * plan_.creep_mps +
                                                   2.0 * kSlowing_mps2 * std::max(0.0, zone.wait_m - 2.0)));
      break;
    case Intention::kBrake:
      stood_s_ += speed <= brake_to_mps_ + kStanding_mps ? kTick_s * kDecisionTicks : 0.0;
      released_ = released_ || stood_s_ > plan_.wait_s;
      if (!released_) limit = speed > brake_to_mps_ ? -plan_.braking_mps2 : 0.0;
      break;
    default:
      break;
  }
  return std::clamp(std::min(behind_leader_mps2(now, way, wanted), limit), -kHardest_mps2,
                    plan_.acceleration_mps2);
}

/// Pure pursuit of the lane, from the offset it began with.
double BranchDriver::steer(const world::Branch& now, double plan_s) const {
  const nodes::Vehicle& car = now.vehicle();
  const double ahead_m = std::clamp(2.5 + 0.8 * car.speed_mps(), 4.0, 20.0);
  const double axle_to_centre_m = 0.5 * car.parameters().length_m - car.parameters().rear_overhang_m;
  map::LaneId lane = lane_;
  double s = s_m_ - axle_to_centre_m + ahead_m;
  for (int i = 0; i < 6 && s > lane_of(now, lane).centre.length_m(); ++i) {
    const map::LaneId next = next_of(now, lane);
    if (next == map::kNoLane) break;
    s -= lane_of(now, lane).centre.length_m();
    lane = next;
  }
  const map::PolylinePose at = lane_of(now, lane).centre.at(s);
  const double left_m = offset_m_ * (1.0 - smooth((plan_s + 0.5) / plan_.change_s));
  const map::Vec2 target{at.point.x - left_m * std::sin(at.heading_rad),
                         at.point.y + left_m * std::cos(at.heading_rad)};
  const map::Vec2 axle = car.rear_axle();
  const double bearing =
      map::wrap_angle(std::atan2(target.y - axle.y, target.x - axle.x) - car.heading_rad());
  const double distance_m = std::max(2.0, std::hypot(target.x - axle.x, target.y - axle.y));
  return std::atan(2.0 * car.parameters().wheelbase_m * std::sin(bearing) / distance_m);
}

world::EgoCommand BranchDriver::drive(const world::Branch& now) {
  const double plan_s = static_cast<double>(ticks_) * kTick_s - fork_.lead_s;
  const std::int64_t tick = ticks_++;
  if (tick == 0) begin(now);
  if (plan_s < -1e-9) return command_ = fork_.held;
  if (lane_ == map::kNoLane) return command_ = {-plan_.braking_mps2, 0.0};  // nothing to follow: stops
  advance(now);
  if (plan_.intention == Intention::kCandidate && plan_s < kHorizon_s) {
    Plan plan;
    plan.kind = PlanKind::kDrive;
    plan.start_ms = plan_.start_ms;
    plan.trajectory = plan_.candidate;
    const gate::Command command =
        tracker_.follow(plan, fork_.time_ms + static_cast<std::uint32_t>(tick * 10),
                        ego_state_of(now.vehicle(), fork_.origin), *fork_.parameters);
    return command_ = {static_cast<double>(command.acceleration_mps2),
                       static_cast<double>(command.steering_rad)};
  }
  const bool goes_on = plan_.intention == Intention::kCandidate;
  if (goes_on && tick % kDecisionTicks == 0 && plan_s < kHorizon_s + kTick_s * kDecisionTicks) begin(now);
  if (lane_ == map::kNoLane) return command_ = {-plan_.braking_mps2, 0.0};  // nothing to follow: stops
  const double since_s = goes_on ? plan_s - kHorizon_s : plan_s;
  if (tick % kDecisionTicks == 0) {
    const std::vector<Part> way = way_ahead(now);
    command_.acceleration_mps2 = choose_mps2(now, way);
  }
  command_.steering_rad = steer(now, since_s);
  return command_;
}

}  // namespace s4tp::train
