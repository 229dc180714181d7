/// Who comes beside the ego, from another lane or into the world: the gaps that leaves it, wherever it may be by then.

#include <algorithm>

#include "sim_host/world/adversary/adversary.hpp"

namespace s4tp::adversary {
namespace {

using traffic::Actor;

constexpr double kEgoMayGain_mps2 = 2.0;     // meanwhile, either way
constexpr double kUsualChange_s = 3.0;       // as Traffic changes lanes: ...
constexpr double kSlowChange_mps = 15.0;     // ... below 5 m/s in proportion
constexpr double kChangesAtLeast_mps = 1.0;  // slower ones are reckoned with as this

}  // namespace

bool Traffic::may_change(const traffic::Car& car, const traffic::WayPart& beside) const {
  if (!ego_) return true;
  Actor self = actor_of(car);
  self.lane = beside.lane;
  self.s_m = -beside.start_m;
  const double rate =
      std::min(1.0 / kUsualChange_s, std::max(car.speed_mps, kChangesAtLeast_mps) / kSlowChange_mps);
  const double to_line_s = 0.5 / rate;
  const double slack_m = 0.5 * kEgoMayGain_mps2 * to_line_s * to_line_s;
  const double gained_mps = kEgoMayGain_mps2 * to_line_s;
  const auto left = [&](const traffic::Leader& found, double rear_mps, double front_mps) {
    const double gap_m = found.gap_m - (rear_mps - front_mps) * to_line_s - slack_m;
    return gap_m >= judge::rss_gap_m(law_.rss, rear_mps, front_mps);
  };
  return leaves_wherever(self, [&](const traffic::TrafficView& two) {
    const traffic::Leader ahead = two.leader(two.actors()[1].way, car.id, car.length_m);
    if (ahead.actor != nullptr &&
        !left(ahead, car.speed_mps, std::max(0.0, ahead.actor->speed_mps - gained_mps))) {
      return false;
    }
    const traffic::Leader behind = two.follower(beside.lane, self.s_m, car.id, car.length_m);
    return behind.actor == nullptr || left(behind, behind.actor->speed_mps + gained_mps, car.speed_mps);
  });
}

bool Traffic::may_come_in(const traffic::Car& car) const {
  if (!ego_) return true;
  return leaves_wherever(actor_of(car), [&](const traffic::TrafficView& two) {
    const traffic::Leader ahead = two.leader(two.actors()[1].way, car.id, car.length_m);
    return ahead.actor == nullptr || ahead.merging ||
           ahead.gap_m >= judge::rss_gap_m(law_.rss, car.speed_mps, ahead.actor->speed_mps);
  });
}

bool Traffic::leaves_wherever(const Actor& self,
                              const std::function<bool(const traffic::TrafficView&)>& leaves) const {
  Actor ego = ego_->actor;
  while (lane(ego.lane).right != map::kNoLane) ego.lane = lane(ego.lane).right;
  for (; ego.lane != map::kNoLane; ego.lane = lane(ego.lane).left) {
    if (!leaves(traffic::TrafficView(*road_, {ego, self}))) return false;
  }
  return true;
}

}  // namespace s4tp::adversary
