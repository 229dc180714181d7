/// Lane changes: those the route needs, and those that gain something (MOBIL: Kesting, Treiber, Helbing
/// 2007).

#include <algorithm>
#include <cmath>

#include "sim_host/world/traffic.hpp"

namespace s4tp::world {
namespace {

constexpr double kSafe_mps2 = 3.0;        // braking a change may ask of the one behind, and of oneself
constexpr double kSafeUrgent_mps2 = 4.0;  // the same where the route needs the change soon
constexpr double kUrgent_m = 60.0;        // from the end of the lane
constexpr double kPause_s = 4.0;          // between changes
constexpr double kLookAgain_s = 0.5;
constexpr double kRoomPerSpeed_s = 1.5;  // lane left ahead that a change needs
constexpr double kRoom_m = 10.0;

}  // namespace

const Driver& Traffic::driver_of(int id) const {
  const auto car = std::find_if(cars_.begin(), cars_.end(), [&](const TrafficCar& c) { return c.id == id; });
  return car != cars_.end() ? car->driver : ego_driver_;
}

bool Traffic::gap_beside(const TrafficCar& car, const WayPart& beside, const TrafficView& view, bool urgent,
                         double& gain_mps2) const {
  const double safe = urgent ? kSafeUrgent_mps2 : kSafe_mps2;
  const RouteGuide& guide = plan_.ways[car.way].guide;
  const std::vector<WayPart> way = view.way_from(beside.lane, -beside.start_m, &guide);
  const double wanted = wanted_speed_mps(car, way);
  const Leader ahead = view.leader(way, car.id, car.length_m);
  double own = free_acceleration_mps2(car.driver, car.speed_mps, wanted);
  if (ahead.actor != nullptr) {
    own = following_acceleration_mps2(car.driver, car.speed_mps, wanted, ahead.gap_m, ahead.actor->speed_mps);
    if (ahead.gap_m < 0.5 * car.driver.min_gap_m) {
      return false;
    }
  }
  const Leader behind = view.follower(beside.lane, -beside.start_m, car.id, car.length_m);
  double their_loss = 0.0;
  if (behind.actor != nullptr) {
    const Driver& driver = driver_of(behind.actor->id);
    const double speed = behind.actor->speed_mps;
    const double theirs =
        following_acceleration_mps2(driver, speed, std::max(speed, 1.0), behind.gap_m, car.speed_mps);
    if (behind.gap_m < 0.5 * driver.min_gap_m || theirs < -safe) {
      return false;
    }
    their_loss = std::max(0.0, -theirs);
  }
  gain_mps2 = own - car.driver.politeness * their_loss;
  return own >= -safe;
}

void Traffic::consider_lane_change(TrafficCar& car, const Actor& self, const TrafficView& view) {
  const NetworkLane& here = lane(car.lane);
  if (car.change_done < 1.0 || time_s() < car.next_change_s || here.in_junction ||
      here.centre.length_m() - car.s_m < kRoom_m + kRoomPerSpeed_s * car.speed_mps) {
    return;
  }
  car.next_change_s = time_s() + kLookAgain_s;
  const RouteGuide& guide = plan_.ways[car.way].guide;
  const int needed = guide.advice(car.lane).changes_needed;
  LaneId target = kNoLane;
  if (needed != 0) {
    const LaneId beside = needed > 0 ? here.left : here.right;
    const bool urgent = here.centre.length_m() - car.s_m < kUrgent_m;
    double gain = 0.0;
    if (beside != kNoLane && gap_beside(car, {beside, -car.s_m}, view, urgent, gain)) {
      target = beside;
    }
  } else if (!car.driver.lane_keeping) {
    double best = car.acceleration_mps2 + car.driver.lane_change_gain_mps2;
    for (const LaneId beside : {here.left, here.right}) {
      double gain = 0.0;
      if (beside != kNoLane && guide.advice(beside).on_route && guide.advice(beside).changes_needed == 0 &&
          gap_beside(car, {beside, -car.s_m}, view, false, gain) && gain > best) {
        best = gain;
        target = beside;
      }
    }
  }
  if (target == kNoLane) {
    return;
  }
  const Vec2 place = here.centre.at(self.s_m).point;
  const PolylineProjection there = lane(target).centre.project(place);
  car.leaving = car.lane;
  car.lane = target;
  car.s_m = there.s_m;
  car.change_from_m = there.d_m;
  car.change_done = 0.0;
  car.known_leader = TrafficCar::kLooking;  // he has looked
  car.next_change_s = time_s() + kPause_s;
}

}  // namespace s4tp::world
