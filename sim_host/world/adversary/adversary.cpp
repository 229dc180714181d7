#include "sim_host/world/adversary/adversary.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace s4tp::adversary {
namespace {

using traffic::Actor;

constexpr double kGain_mps2 = 2.0;  // law.gain_mps2 of the firmware's defaults
constexpr double kOverLimit = 1.1;  // law.over_limit
constexpr double kRoom_m = 0.1;     // a line is kept off by
constexpr double kAtLine_m = 0.3;   // who waits for a licence of those who stand is so near

std::vector<judge::Stretch> stretches_of(const traffic::RoadIndex& road,
                                         const std::vector<traffic::WayPart>& way) {
  std::vector<judge::Stretch> stretches;
  for (const traffic::WayPart& part : way) {
    const double end_m = part.start_m + road.lane(part.lane).centre.length_m();
    stretches.push_back({part.lane, part.start_m, part.start_m, end_m});
  }
  return stretches;
}

/// Where a zone's ground lies ahead of a car's centre.
struct Ground {
  double entry_m = 0.0;
  double exit_m = 0.0;
};

std::optional<Ground> ground_of_other(const judge::ZoneOnWay& zone, const Actor& other) {
  const double grown_m = judge::longer_by_m(other.length_m);
  for (const traffic::WayPart& part : other.way) {
    if (part.lane == zone.meeting.other) {
      const Ground ground{part.start_m + zone.meeting.other_entry_m - grown_m,
                          part.start_m + zone.meeting.other_exit_m + grown_m};
      if (ground.exit_m > 0.0) return ground;
    }
  }
  return std::nullopt;
}

}  // namespace

judge::Law promised_law() {
  judge::Law law;
  law.acceleration_mps2 = kGain_mps2;
  law.over_limit = kOverLimit;
  return law;
}

Traffic::Traffic(const scenario::Scenario& scenario, std::uint64_t episode, std::uint64_t seed,
                 const judge::Law& law)
    : traffic::Traffic(scenario, episode, seed), law_(law) {
  const auto plan = std::make_shared<traffic::FlowPlan>(*plan_);
  for (traffic::Departure& departure : plan->departures) {
    traffic::Driver& driver = departure.driver;
    driver.acceleration_mps2 = law.acceleration_mps2;
    driver.emergency_mps2 = law.rss.front_braking_mps2;
    driver.speed_factor = law.over_limit;
    driver.imperfection = 0.0;
    driver.courtesy = 0.0;
  }
  plan_ = plan;
}

std::unique_ptr<traffic::TrafficEngine> Traffic::clone() const {
  return std::make_unique<Traffic>(*this);
}

void Traffic::decide(const Actor* ego) {
  const traffic::TrafficView others(*road_, actors(nullptr));
  if (ego == nullptr || ego->lane == map::kNoLane) {
    ego_.reset();
  } else {
    watch(*ego, others);
  }
  std::erase_if(minds_, [&](const auto& mind) {
    return std::none_of(cars_.begin(), cars_.end(),
                        [&](const traffic::Car& car) { return car.id == mind.first; });
  });
  for (std::size_t i = 0; i < cars_.size(); ++i) {
    traffic::Car& car = cars_[i];
    const Actor& self = others.actors()[i];
    const auto [found, fresh] = minds_.try_emplace(car.id);
    Mind& mind = found->second;
    if (fresh && ego_ && ego_->inside >= 0) {  // finds the ego there
      mind.owes_zone = true;
      mind.owes_since_s = time_s();
    }
    mind.stood_s = car.speed_mps < law_.standing_mps ? mind.stood_s + kDecision_s : 0.0;
    car.acceleration_mps2 = acceleration(car, self, others);
    if (ego_) {
      const double most = hardest_mps2(law_, obstacles_of(car, self, mind), car.speed_mps,
                                       car.acceleration_mps2, kDecision_s);
      const std::uint64_t own =
          traffic::next_seed(traffic::next_seed(seed_ ^ 0xAD7E) + static_cast<std::uint64_t>(car.id));
      const bool changing = car.change_done < 0.5;  // the gaps that were left are kept until the line
      car.acceleration_mps2 =
          chosen_mps2({*road_, law_, self, ego_->actor, time_s(), kDecision_s, mind.stood_s, changing, own},
                      most, mind.mood);
    }
    consider_lane_change(car, self, others);
  }
  insert_waiting(ego);
}

void Traffic::watch(const Actor& ego, const traffic::TrafficView& others) {
  ego_driven_m_ += ego_ ? 0.5 * kDecision_s * (ego_->actor.speed_mps + ego.speed_mps) : 0.0;
  Watched now;
  now.actor = ego;
  now.actor.way = others.way_from(ego.lane, ego.s_m, ego.guide);
  now.groups = judge::zone_groups(*road_, stretches_of(*road_, now.actor.way), ego.length_m);
  ego_ = std::move(now);
  ego_stood_s_ = ego.speed_mps < law_.standing_mps ? ego_stood_s_ + kDecision_s : 0.0;
  bool near = false;
  for (std::size_t i = 0; i < ego_->groups.size(); ++i) {
    const judge::ZoneGroup& group = ego_->groups[i];
    const bool ahead = group.entry_m > 0.0;
    near = near || (ahead && group.entry_m < law_.shown_within_m);
    if (!ahead && group.exit_m > 0.0) ego_->inside = static_cast<int>(i);
    if (ego_->taken < 0 && group.exit_m > 0.0 && !judge::can_stop(law_, ego.speed_mps, group.entry_m))
      ego_->taken = static_cast<int>(i);
  }
  ego_shown_s_ = near || ego_->inside >= 0 ? ego_shown_s_ + kDecision_s : 0.0;
  if (ego_->taken < 0) {
    taken_entered_ = false;
    for (auto& [id, mind] : minds_) mind.owes_zone = false;
  } else {
    bind(ego_->groups[static_cast<std::size_t>(ego_->taken)], others);
  }
}

void Traffic::bind(const judge::ZoneGroup& group, const traffic::TrafficView& others) {
  const bool another = ego_driven_m_ + group.entry_m > taken_until_m_;
  if (!another && taken_entered_) return;
  taken_entered_ = group.entry_m <= 0.0;
  taken_until_m_ = ego_driven_m_ + group.exit_m;
  for (const Actor& other : others.actors()) {
    const auto [found, fresh] = minds_.try_emplace(other.id);
    Mind& mind = found->second;
    if (another) mind.owes_zone = false;
    if (mind.owes_zone) continue;
    const bool finds_it_taken = fresh && !another;
    mind.owes_zone =
        finds_it_taken ||
        std::all_of(group.zones.begin(), group.zones.end(), [&](const judge::ZoneOnWay& zone) {
          return zone.meeting.rule != map::Rule::kFirstYields || ego_is_licensed(zone, other, mind);
        });
    mind.owes_since_s = time_s();
  }
}

bool Traffic::ego_is_licensed(const judge::ZoneOnWay& zone, const Actor& other, const Mind& mind) const {
  const std::optional<Ground> ground = ground_of_other(zone, other);
  if (!ground) return true;
  const double limit = limit_mps(zone.lane);
  judge::Entry entry;
  entry.merging = zone.meeting.merging;
  entry.gone_after_s = traffic::time_to_cover_s(zone.exit_m, ego_->actor.speed_mps, kGain_mps2, limit);
  entry.gone_mps = std::min(limit, ego_->actor.speed_mps + kGain_mps2 * entry.gone_after_s);
  entry.other_to_zone_m = ground->entry_m;
  entry.other_to_end_m = ground->exit_m;
  entry.other_mps = other.speed_mps;
  entry.other_limit_mps = std::max(limit_mps(other.lane), limit_mps(zone.meeting.other));
  entry.bumpers_m = 0.5 * (ego_->actor.length_m + other.length_m);
  entry.shown_s = ego_shown_s_;
  entry.other_stood_s = mind.stood_s;
  entry.both_stood_s = std::min(mind.stood_s, ego_stood_s_);
  return judge::licence_of(law_, entry) != judge::Licence::kNone;
}

std::vector<Obstacle> Traffic::obstacles_of(const traffic::Car& car, const Actor& self, Mind& mind) const {
  std::vector<Obstacle> all;
  ego_ahead(car, self, mind, all);
  zones_ahead(car, self, mind, all);
  return all;
}

void Traffic::ego_ahead(const traffic::Car& car, const Actor& self, Mind& mind,
                        std::vector<Obstacle>& all) const {
  const traffic::TrafficView two(*road_, {ego_->actor, self});
  const traffic::Leader leader = two.leader(self.way, car.id, car.length_m);
  if (leader.actor == nullptr || (leader.merging && (ego_->inside < 0 || !mind.owes_zone))) {
    mind.ego_ahead_s = -1.0;
    return;
  }
  Obstacle obstacle{leader.gap_m, leader.actor->speed_mps, true, 0.0};
  const bool at_distance = leader.gap_m >= judge::rss_gap_m(law_.rss, car.speed_mps, obstacle.speed_mps);
  if (leader.merging && mind.ego_ahead_s < 0.0) {
    // The duty that began with its going in goes on in the lane.
    mind.ego_ahead_s = mind.owes_since_s;
    mind.owes_ahead = true;
  } else if (mind.ego_ahead_s < 0.0) {
    mind.ego_ahead_s = at_distance ? time_s() - law_.settle_s : time_s();
    obstacle.at_distance = false;
    obstacle.answers_after_s = law_.reaction_s;
    mind.owes_ahead = at_distance || keeps(law_, obstacle, car.speed_mps, 0.0, 0.0);
  }
  const double since_s = time_s() - mind.ego_ahead_s;
  obstacle.at_distance = since_s >= law_.settle_s - 1e-6;
  obstacle.answers_after_s = std::max(0.0, law_.reaction_s - since_s);
  if (obstacle.at_distance || mind.owes_ahead) all.push_back(obstacle);
}

void Traffic::zones_ahead(const traffic::Car& car, const Actor& self, const Mind& mind,
                          std::vector<Obstacle>& all) const {
  for (const judge::ZoneGroup& group :
       judge::zone_groups(*road_, stretches_of(*road_, self.way), car.length_m)) {
    for (const judge::ZoneOnWay& zone : group.zones) {
      const std::optional<Ground> ego = ground_of_other(zone, ego_->actor);
      if (!ego) continue;
      const bool ego_takes =
          ego_->taken >= 0 && ego->entry_m <= ego_->groups[static_cast<std::size_t>(ego_->taken)].exit_m;
      Obstacle line{group.entry_m - kRoom_m, 0.0, false, 0.0};
      if (zone.meeting.rule == map::Rule::kFirstHasPriority) {
        if (!ego_takes || !mind.owes_zone || zone.entry_m <= 0.0) continue;
        if (zone.meeting.merging && mind.ego_ahead_s >= 0.0) continue;  // followed
        line.gap_m = zone.entry_m - kRoom_m;
        line.answers_after_s = std::max(0.0, law_.reaction_s - (time_s() - mind.owes_since_s));
      } else {
        // Who is in the group stops before the zone where that can still be done.
        const double to_line_m = group.entry_m > 0.0 ? group.entry_m : zone.entry_m;
        line.gap_m = to_line_m - kRoom_m;
        const double stop_m =
            judge::stopping_m(car.speed_mps, 0.0, 0.0, car.speed_mps, law_.duty_braking_mps2);
        const bool in = to_line_m <= 0.0 || (group.entry_m <= 0.0 && stop_m > line.gap_m);
        if (in || may_enter(self, mind, to_line_m, zone, ego->entry_m, ego->exit_m)) continue;
      }
      all.push_back(line);
    }
  }
}

bool Traffic::may_enter(const Actor& self, const Mind& mind, double to_group_m, const judge::ZoneOnWay& zone,
                        double ego_entry_m, double ego_exit_m) const {
  if (zone.meeting.rule == map::Rule::kFirstCome) return ego_entry_m > 0.0;
  const Actor& ego = ego_->actor;
  const double limit = limit_mps(zone.lane);
  const double until_s = traffic::time_to_cover_s(to_group_m, self.speed_mps, 0.0, limit);
  if (!std::isfinite(until_s) && to_group_m > kAtLine_m) return false;
  const double wait_s = std::isfinite(until_s) ? until_s : 0.0;
  const double ego_limit = std::max(limit_mps(ego.lane), limit_mps(zone.meeting.other));
  const double top_mps = judge::top_speed_mps(law_, ego.speed_mps, ego_limit);
  const double reached_mps = std::min(top_mps, ego.speed_mps + law_.acceleration_mps2 * wait_s);
  const double ego_way_m = 0.5 * (ego.speed_mps + reached_mps) * wait_s;
  judge::Entry entry;
  entry.merging = zone.meeting.merging;
  entry.gone_after_s =
      traffic::time_to_cover_s(zone.exit_m - to_group_m, self.speed_mps, law_.acceleration_mps2, limit);
  entry.gone_mps = std::min(limit, self.speed_mps + law_.acceleration_mps2 * entry.gone_after_s);
  entry.other_to_zone_m = ego_entry_m - ego_way_m;
  entry.other_to_end_m = ego_exit_m - ego_way_m;
  entry.other_mps = reached_mps;
  entry.other_limit_mps = ego_limit;
  entry.bumpers_m = 0.5 * (self.length_m + ego.length_m);
  const bool at_line = to_group_m < law_.shown_within_m;
  entry.shown_s = at_line ? mind.stood_s : 0.0;
  entry.other_stood_s = to_group_m < kAtLine_m ? ego_stood_s_ : 0.0;
  entry.both_stood_s = to_group_m < kAtLine_m ? std::min(mind.stood_s, ego_stood_s_) : 0.0;
  return judge::licence_of(law_, entry) != judge::Licence::kNone;
}

}  // namespace s4tp::adversary
