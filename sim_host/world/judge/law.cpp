#include "sim_host/world/judge/law.hpp"

#include <algorithm>

#include "sim_host/world/traffic/traffic_driver.hpp"

namespace s4tp::judge {
namespace {

/// Way covered in a time while speeding up to at most `top_mps`.
double covered_m(double speed_mps, double acceleration_mps2, double top_mps, double time_s) {
  const double run_up_s =
      acceleration_mps2 > 0.0 ? std::max(0.0, top_mps - speed_mps) / acceleration_mps2 : 0.0;
  const double gaining_s = std::min(time_s, run_up_s);
  const double reached_mps = speed_mps + acceleration_mps2 * gaining_s;
  return (speed_mps + 0.5 * acceleration_mps2 * gaining_s) * gaining_s + reached_mps * (time_s - gaining_s);
}

double reached_mps(double speed_mps, double acceleration_mps2, double top_mps, double time_s) {
  return std::max(speed_mps, std::min(top_mps, speed_mps + acceleration_mps2 * time_s));
}

bool clear(const Law& law, const Entry& entry) {
  const double top_mps = top_speed_mps(law, entry.other_mps, entry.other_limit_mps);
  if (entry.other_to_zone_m <= 0.0) {
    return false;
  }
  if (!entry.merging) {
    return traffic::time_to_cover_s(entry.other_to_zone_m, entry.other_mps, law.acceleration_mps2, top_mps) >=
           entry.gone_after_s;
  }
  const double gap_m = entry.other_to_end_m - entry.bumpers_m -
                       covered_m(entry.other_mps, law.acceleration_mps2, top_mps, entry.gone_after_s);
  const double then_mps = reached_mps(entry.other_mps, law.acceleration_mps2, top_mps, entry.gone_after_s);
  return gap_m >= rss_gap_m(law.rss, then_mps, entry.gone_mps);
}

}  // namespace

double rss_gap_m(const Rss& rss, double rear_mps, double front_mps) {
  const double reached = rear_mps + rss.acceleration_mps2 * rss.reaction_s;
  const double rear_m =
      0.5 * (rear_mps + reached) * rss.reaction_s + reached * reached / (2.0 * rss.braking_mps2);
  return std::max(0.0, rear_m - front_mps * front_mps / (2.0 * rss.front_braking_mps2));
}

double stopping_m(double speed_mps, double delay_s, double acceleration_mps2, double top_mps,
                  double braking_mps2) {
  const double then_mps = reached_mps(speed_mps, acceleration_mps2, top_mps, delay_s);
  return covered_m(speed_mps, acceleration_mps2, top_mps, delay_s) +
         then_mps * then_mps / (2.0 * braking_mps2);
}

bool can_stop(const Law& law, double speed_mps, double distance_m) {
  return stopping_m(speed_mps, law.reaction_s, 0.0, speed_mps, law.duty_braking_mps2) <= distance_m;
}

double top_speed_mps(const Law& law, double speed_mps, double limit_mps) {
  return std::max(speed_mps, law.over_limit * limit_mps);
}

Licence licence_of(const Law& law, const Entry& entry) {
  if (clear(law, entry)) {
    return Licence::kClear;
  }
  const double top_mps = top_speed_mps(law, entry.other_mps, entry.other_limit_mps);
  const bool before = entry.other_to_zone_m > 0.0;
  if (before && entry.in_sight &&
      stopping_m(entry.other_mps, law.asked_after_s, law.acceleration_mps2, top_mps,
                 law.asked_braking_mps2) <= entry.other_to_zone_m) {
    return Licence::kCanStop;
  }
  const bool waits = entry.other_stood_s > 0.0 && entry.in_sight && entry.shown_s >= law.shown_s;
  if (before && (waits || entry.both_stood_s >= law.deadlock_s)) {
    return Licence::kStands;
  }
  return Licence::kNone;
}

}  // namespace s4tp::judge
