/// Lane changes: those the route needs, and those that gain something (MOBIL: Kesting, Treiber, Helbing
/// 2007, symmetric rule); and what drivers do about somebody whose lane ends beside them.

#include <algorithm>
#include <cmath>

#include "sim_host/world/traffic/traffic.hpp"

namespace s4tp::traffic {
namespace {

constexpr double kUrgent_mps2 = 1.0;  // asked on top of the usual where the route needs the change soon
constexpr double kUrgent_m = 60.0;    // from the end of the lane
constexpr double kPause_s = 4.0;      // between changes
constexpr double kLookAgain_s = 0.5;
constexpr double kRoomPerSpeed_s = 1.5;  // lane left ahead that a change needs
constexpr double kRoom_m = 10.0;
constexpr double kMergingAhead_m = 40.0;    // who wants in is let in, or kept out, from here on
constexpr double kLetIn_mps2 = 2.0;         // comfortable braking, which a courteous driver takes upon itself
constexpr double kLetInAbove_mps = 3.0;     // and does not stop for it
constexpr double kRivalHeadwayShare = 0.5;  // of its headway a rival gives up to keep somebody out
constexpr double kRivalSpeedShare = 0.08;   // by which it drives faster
constexpr double kRivalBehind_m = 5.0;

/// As following, `nobody` ahead being no leader.
double towards(const Driver& driver, double speed_mps, double wanted_mps, const Leader& leader) {
  return leader.actor == nullptr ? free_acceleration_mps2(driver, speed_mps, wanted_mps)
                                 : following_acceleration_mps2(driver, speed_mps, wanted_mps, leader.gap_m,
                                                               leader.actor->speed_mps);
}

}  // namespace

const Driver& Traffic::driver_of(int id) const {
  const auto car = std::find_if(cars_.begin(), cars_.end(), [&](const Car& c) { return c.id == id; });
  return car != cars_.end() ? car->driver : ego_driver_;
}

bool Traffic::safe_beside(const Car& car, const WayPart& beside, const TrafficView& view, bool urgent) const {
  const double safe = urgent ? car.driver.asked_braking_mps2 + kUrgent_mps2 : car.driver.asked_braking_mps2;
  const map::RouteGuide& guide = plan_->ways[car.way].guide;
  const std::vector<WayPart> way = view.way_from(beside.lane, -beside.start_m, &guide);
  const Leader ahead = view.leader(way, car.id, car.length_m);
  if (ahead.actor != nullptr && ahead.gap_m < 0.5 * car.driver.min_gap_m) {
    return false;
  }
  const Leader behind = view.follower(beside.lane, -beside.start_m, car.id, car.length_m);
  if (behind.actor != nullptr) {
    const Driver& driver = driver_of(behind.actor->id);
    const double speed = behind.actor->speed_mps;
    const double theirs =
        following_acceleration_mps2(driver, speed, std::max(speed, 1.0), behind.gap_m, car.speed_mps);
    if (behind.gap_m < 0.5 * driver.min_gap_m || theirs < -safe) {
      return false;
    }
  }
  return towards(car.driver, car.speed_mps, wanted_speed_mps(car, way), ahead) >= -safe;
}

/// MOBIL's incentive: own gain, and by politeness that of the new follower and of the old one.
double Traffic::lane_change_gain(const Car& car, const TrafficView& view, const WayPart& beside) const {
  const map::RouteGuide& guide = plan_->ways[car.way].guide;
  const std::vector<WayPart> way_now = view.way_from(car.lane, car.s_m, &guide);
  const std::vector<WayPart> way_then = view.way_from(beside.lane, -beside.start_m, &guide);
  const Leader leader_now = view.leader(way_now, car.id, car.length_m);
  const Leader leader_then = view.leader(way_then, car.id, car.length_m);
  const double own = towards(car.driver, car.speed_mps, wanted_speed_mps(car, way_then), leader_then) -
                     towards(car.driver, car.speed_mps, wanted_speed_mps(car, way_now), leader_now);

  Actor self;
  self.speed_mps = car.speed_mps;
  /// What a follower gains when `before` is its leader no more but `after`.
  const auto gain_of = [&](const Leader& follower, const Leader& before, const Leader& after) {
    const Driver& driver = driver_of(follower.actor->id);
    const double speed = follower.actor->speed_mps;
    const double wanted =
        std::min(driver.max_speed_mps, lane(follower.actor->lane).speed_limit_mps * driver.speed_factor);
    return towards(driver, speed, wanted, after) - towards(driver, speed, wanted, before);
  };
  /// The leader a follower has once we are not between them.
  const auto beyond = [&](const Leader& follower, const Leader& leader) {
    Leader far = leader;
    far.gap_m += follower.gap_m + car.length_m;
    return far;
  };
  double others = 0.0;
  if (const Leader behind = view.follower(beside.lane, -beside.start_m, car.id, car.length_m); behind.actor) {
    others += gain_of(behind, beyond(behind, leader_then), {&self, behind.gap_m, false});
  }
  if (const Leader behind = view.follower(car.lane, car.s_m, car.id, car.length_m); behind.actor) {
    others += gain_of(behind, {&self, behind.gap_m, false}, beyond(behind, leader_now));
  }
  return own + car.driver.politeness * others;
}

void Traffic::consider_lane_change(Car& car, const Actor& self, const TrafficView& view) {
  const map::Lane& here = lane(car.lane);
  if (car.change_done < 1.0 || time_s() < car.next_change_s || here.in_junction ||
      here.centre.length_m() - car.s_m < kRoom_m + kRoomPerSpeed_s * car.speed_mps) {
    return;
  }
  car.next_change_s = time_s() + kLookAgain_s;
  const map::RouteGuide& guide = plan_->ways[car.way].guide;
  const int needed = guide.advice(car.lane).changes_needed;
  map::LaneId target = map::kNoLane;
  if (needed != 0) {
    const map::LaneId beside = needed > 0 ? here.left : here.right;
    const bool urgent = here.centre.length_m() - car.s_m < kUrgent_m;
    if (beside != map::kNoLane && safe_beside(car, {beside, -car.s_m}, view, urgent)) {
      target = beside;
    }
  } else if (!car.driver.lane_keeping) {
    double best = car.driver.change_threshold_mps2;
    for (const map::LaneId beside : {here.left, here.right}) {
      if (beside == map::kNoLane || !guide.advice(beside).on_route ||
          guide.advice(beside).changes_needed != 0) {
        continue;
      }
      const WayPart place{beside, -car.s_m};
      const double gain = lane_change_gain(car, view, place);
      if (gain > best && safe_beside(car, place, view, false)) {
        best = gain;
        target = beside;
      }
    }
  }
  if (target == map::kNoLane || !may_change(car, {target, -car.s_m})) {
    return;
  }
  const map::Vec2 place = here.centre.at(self.s_m).point;
  const map::PolylineProjection there = lane(target).centre.project(place);
  car.leaving = car.lane;
  car.lane = target;
  car.s_m = there.s_m;
  car.change_from_m = there.d_m;
  car.change_done = 0.0;
  car.known_leader = Car::kLooking;  // it has looked
  car.next_change_s = time_s() + kPause_s;
}

/// Beside a lane that ends: the next one behind somebody on it lets that one in, or closes up. \param result  what
/// it would do otherwise
double Traffic::towards_merging(const Car& car, const Actor& self, const TrafficView& view,
                                const Leader& leader, double wanted_mps, double result) const {
  const map::Lane& here = lane(car.lane);
  if ((car.driver.courtesy <= 0.0 && car.driver.rivalry <= 0.0) || here.successors.empty()) {
    return result;
  }
  for (const Actor& other : view.actors()) {
    const bool beside = other.lane != map::kNoLane && (other.lane == here.left || other.lane == here.right);
    if (!beside || !lane(other.lane).successors.empty()) {
      continue;
    }
    const double ahead_m = here.centre.project(lane(other.lane).centre.at(other.s_m).point).s_m - self.s_m;
    const double gap_m = ahead_m - 0.5 * (car.length_m + other.length_m);
    const bool next_behind = leader.actor == nullptr || leader.gap_m > gap_m;
    if (ahead_m < -kRivalBehind_m || ahead_m > kMergingAhead_m || !next_behind) {
      continue;
    }
    if (car.driver.rivalry > 0.0) {
      Driver rival = car.driver;
      rival.headway_s *= 1.0 - kRivalHeadwayShare * rival.rivalry;
      result = std::max(result, towards(rival, car.speed_mps,
                                        wanted_mps * (1.0 + kRivalSpeedShare * rival.rivalry), leader));
    } else if (ahead_m > 0.0 && car.speed_mps > kLetInAbove_mps) {
      const double opening =
          following_acceleration_mps2(car.driver, car.speed_mps, wanted_mps, gap_m, other.speed_mps);
      result = std::min(result, std::max(opening, -kLetIn_mps2 * car.driver.courtesy));
    }
  }
  return result;
}

}  // namespace s4tp::traffic
