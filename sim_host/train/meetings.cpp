#include "sim_host/train/meetings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace s4tp::train {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

struct Zone {
  SampleRule rule = SampleRule::kNoZone;
  bool merging = false;
  double ego_entry_m = kNever;  ///< odometers
  double ego_exit_m = 0.0;
  double car_entry_m = 0.0;
  double car_exit_m = 0.0;
};

bool lead_into_one(const map::Lane& a, const map::Lane& b) {
  return std::any_of(a.successors.begin(), a.successors.end(), [&](map::LaneId next) {
    return std::find(b.successors.begin(), b.successors.end(), next) != b.successors.end();
  });
}

SampleRule rule_of(map::Rule rule, bool ego_first) {
  if (rule == map::Rule::kFirstCome) return SampleRule::kFirstCome;
  return (rule == map::Rule::kFirstYields) == ego_first ? SampleRule::kHasPriority : SampleRule::kYields;
}

/// 1: the car came after the ego, 0: before it, -1: not settled.
std::int8_t order_of(const judge::Journey& ego, const judge::Journey& car, const Zone& zone) {
  const double ego_in_s = ego.time_at(zone.ego_entry_m);
  const double ego_out_s = ego.time_at(zone.ego_exit_m);
  const double car_in_s = car.time_at(zone.car_entry_m);
  const double car_out_s = car.time_at(zone.car_exit_m);
  if (ego_out_s < kNever && ego_out_s <= car_in_s) return 1;
  if (car_out_s < kNever && car_out_s <= ego_in_s) return 0;
  if (ego_in_s == kNever || car_in_s == kNever) return -1;  // the one inside has not left yet
  if (zone.merging && ego_in_s != car_in_s) return ego_in_s < car_in_s ? 1 : 0;
  return ego_out_s == car_out_s ? std::int8_t{-1} : static_cast<std::int8_t>(ego_out_s < car_out_s ? 1 : 0);
}

}  // namespace

Meetings::Meetings(const map::Network& network, const map::RouteGuide& guide,
                   std::span<const traffic::Snapshot> drive)
    : network_(network), journeys_(judge::journeys_of(network, drive, true)), ego_(journeys_.size()) {
  for (std::size_t i = 0; i < journeys_.size(); ++i) {
    const bool ego = journeys_[i].id == 0;
    if (ego) ego_ = i;
    judge::extend(network, ego ? &guide : nullptr, journeys_[i]);
  }
}

Meeting Meetings::with(int id) const {
  Meeting meeting;
  meeting.entry_s = kNever;
  const auto car = std::find_if(journeys_.begin(), journeys_.end(),
                                [&](const judge::Journey& journey) { return journey.id == id; });
  if (ego_ == journeys_.size() || car == journeys_.end()) return meeting;
  const judge::Journey& ego = journeys_[ego_];
  Zone nearest;
  for (const judge::Stretch& ours : ego.stretches) {
    for (const judge::Stretch& theirs : car->stretches) {
      meeting.shares = meeting.shares || ours.lane == theirs.lane;
      for (const map::Conflict& conflict : network_.conflicts) {
        const bool ego_first = conflict.first == ours.lane && conflict.second == theirs.lane;
        if (!ego_first && (conflict.second != ours.lane || conflict.first != theirs.lane)) continue;
        Zone zone;
        zone.rule = rule_of(conflict.rule, ego_first);
        zone.merging = lead_into_one(network_.lanes[static_cast<std::size_t>(ours.lane)],
                                     network_.lanes[static_cast<std::size_t>(theirs.lane)]);
        zone.ego_entry_m = ours.start_m + (ego_first ? conflict.first_entry_m : conflict.second_entry_m);
        zone.ego_exit_m = ours.start_m + (ego_first ? conflict.first_exit_m : conflict.second_exit_m);
        zone.car_entry_m = theirs.start_m + (ego_first ? conflict.second_entry_m : conflict.first_entry_m);
        zone.car_exit_m = theirs.start_m + (ego_first ? conflict.second_exit_m : conflict.first_exit_m);
        const bool on_both =
            zone.ego_exit_m > std::max(0.0, ours.from_m) && zone.ego_entry_m < ours.until_m &&
            zone.car_exit_m > std::max(0.0, theirs.from_m) && zone.car_entry_m < theirs.until_m;
        if (on_both && zone.ego_entry_m < nearest.ego_entry_m) nearest = zone;
      }
    }
  }
  meeting.rule = nearest.rule;
  if (nearest.rule == SampleRule::kNoZone) return meeting;
  meeting.shares = true;
  meeting.yields = order_of(ego, *car, nearest);
  meeting.entry_s = ego.time_at(nearest.ego_entry_m);
  return meeting;
}

}  // namespace s4tp::train
