#pragma once
/// One driver as data, and the laws it drives by: car following, imperfection, gap acceptance.

#include <cstdint>

#include "sim_host/world/scenario/traffic_demand.hpp"
#include "sim_host/world/traffic/random.hpp"

namespace s4tp::traffic {

/// Braking asked of oneself, and of others, where nothing presses.
inline constexpr double kComfortableBraking_mps2 = 2.0;

/// Drawn once a car from its flow's DriverModel. A social mix of drivers differs in these values only.
struct Driver {
  double acceleration_mps2 = 2.6;
  double deceleration_mps2 = 4.5;  ///< hardest in ordinary driving
  double emergency_mps2 = 6.5;     ///< hardest at all, 4.5 .. 9
  double headway_s = 1.0;
  double min_gap_m = 2.5;
  double speed_factor = 1.0;
  double max_speed_mps = 55.0;
  double imperfection = 0.5;           ///< SUMO's sigma
  double reaction_s = 0.75;            ///< until something unexpected is acted upon, 0.5 .. 1
  double gap_margin_s = 1.0;           ///< wanted between own leaving of a zone and the other's arrival
  double patience_s = 15.0;            ///< waiting time after which the margin is down to a quarter
  double politeness = 0.0;             ///< MOBIL's p: weight of the others' gain or loss
  double change_threshold_mps2 = 0.1;  ///< MOBIL: what a change must gain
  double asked_braking_mps2 = 3.0;     ///< MOBIL's b_safe: what it may ask of the one behind, and of oneself
  double courtesy = 0.0;  ///< 0 .. 1: braking, in shares of comfortable, to let in or let go somebody
  double rivalry = 0.0;   ///< 0 .. 1: closes up on somebody who wants in
  bool lane_keeping = false;
};

[[nodiscard]] Driver draw_driver(const scenario::DriverModel& model, Random& random);

/// Imperfection at work: how much of a driver's mind is elsewhere, 0 .. 1, another value each second, each
/// driver's seconds beginning at an instant of their own. A function of its arguments and of nothing else:
/// no stream that drivers share, so in a branch of a world everybody is as distracted as in the other one.
/// \param car  the driver's id
[[nodiscard]] double distraction(std::uint64_t seed, int car, double time_s);

/// Free-road part: towards the wanted speed; above it, ordinary braking growing with the excess.
[[nodiscard]] double free_acceleration_mps2(const Driver& driver, double speed_mps, double wanted_mps);

/// The improved intelligent driver model (Treiber, Kesting: Traffic Flow Dynamics, 11.3.7).
/// \param gap_m  bumper to bumper, to a leader driving `leader_mps`; infinity: none
/// \return unbounded below; the caller limits it to what the driver does
[[nodiscard]] double following_acceleration_mps2(const Driver& driver, double speed_mps, double wanted_mps,
                                                 double gap_m, double leader_mps);

/// Braking that stops at a line `distance_m` ahead of the bumper.
[[nodiscard]] double stopping_acceleration_mps2(const Driver& driver, double speed_mps, double wanted_mps,
                                                double distance_m);

/// Time to cover a distance from `speed_mps`, accelerating to at most `top_mps`. \return infinity: never
[[nodiscard]] double time_to_cover_s(double distance_m, double speed_mps, double acceleration_mps2,
                                     double top_mps);

/// Margin this driver asks of a gap after having waited so long.
[[nodiscard]] double accepted_margin_s(const Driver& driver, double waited_s);

}  // namespace s4tp::traffic
