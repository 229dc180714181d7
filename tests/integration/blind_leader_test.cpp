// The leader brakes as hard as can be while its track stops coming: nobody is hit, whichever comes first.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <memory>

#include "algo/planner/planner.hpp"
#include "tests/support/ecu_rig.hpp"

namespace s4tp::ecu {
namespace {

constexpr double kFollowing_mps = 11.0;
constexpr double kHardest_mps2 = 8.0;
constexpr double kLength_m = 4.5;
constexpr int kClosing = 700;   // ticks after which the ego still closes up, ...
constexpr int kSettled = 1300;  // ... and after which the gap is the planner's own

/// What the perception does from the fault's tick on.
enum class Blind { kNoLists, kNoLeader, kEverySecond };

const char* name_of(Blind blind) {
  constexpr const char* kNames[] = {"lists stop", "the leader is missing for 0.9 s",
                                    "every second list is lost"};
  return kNames[static_cast<int>(blind)];
}

struct Outcome {
  double least_gap_m = 1e3;
  double followed_at_m = 0.0;
  bool stood = false;
};

/// Follows a leader that brakes at tick `brakes`; the fault comes `onset` ticks later.
Outcome follow(Blind blind, int brakes, int onset) {
  const auto rig = std::make_unique<BasicRig<planner::Planner>>();
  Outcome outcome;
  EXPECT_EQ(rig->start(), Status::kOk);
  rig->plant.speed_mps = kFollowing_mps;
  double leader_m = 45.0;  // its centre
  double leader_mps = kFollowing_mps;
  rig->engage = true;
  for (int tick = 0; tick < brakes + 800; ++tick) {  // the last metre is crept
    const int since = tick - brakes - onset;
    const bool missing = blind == Blind::kNoLeader && since >= 0 && since < 90;
    if (blind == Blind::kNoLists && since >= 0) rig->tracks = false;
    if (blind == Blind::kEverySecond && since >= 0) rig->tracks = since / 10 % 2 == 1;
    rig->track_list.count = missing ? 0 : 1;
    wire::Track& track = rig->track_list.items[0];
    track.id = 7;
    track.x_m = static_cast<float>(leader_m);
    track.speed_mps = static_cast<float>(leader_mps);
    track.acceleration_mps2 = tick >= brakes && leader_mps > 0.0 ? static_cast<float>(-kHardest_mps2) : 0.0F;
    track.length_m = static_cast<float>(kLength_m);
    track.width_m = 1.8F;
    rig->tick();
    if (tick >= brakes) leader_mps = std::max(0.0, leader_mps - 0.01 * kHardest_mps2);
    leader_m += 0.01 * leader_mps;
    const Parameters parameters;
    const double front_m = rig->plant.x_m + static_cast<double>(parameters.vehicle.length_m -
                                                                parameters.vehicle.rear_overhang_m);
    const double gap_m = leader_m - 0.5 * kLength_m - front_m;
    if (tick == brakes) outcome.followed_at_m = gap_m;
    if (tick >= brakes) outcome.least_gap_m = std::min(outcome.least_gap_m, gap_m);
    if (tick == brakes - 61) {
      EXPECT_EQ(rig->ecu.mode(), Mode::kDriving);
    }
    outcome.stood = outcome.stood || (tick > brakes && rig->plant.speed_mps < 0.05);
  }
  return outcome;
}

// At 11 m/s the leader brakes at 8 m/s^2, while the ego closes up to it or has done so; from 0.6 s before it to 0.4
// s after it the perception goes blind.
TEST(BlindLeader, IsNotHit) {
  for (const Blind blind : {Blind::kNoLists, Blind::kNoLeader, Blind::kEverySecond}) {
    for (const int brakes : {kClosing, kSettled}) {
      double least_m = 1e3;
      double followed_m = 0.0;
      for (int onset = -60; onset <= 40; onset += 20) {
        const Outcome outcome = follow(blind, brakes, onset);
        EXPECT_GT(outcome.least_gap_m, 0.0) << name_of(blind) << ", from " << 10 * onset << " ms";
        EXPECT_TRUE(outcome.stood) << name_of(blind) << ", from " << 10 * onset << " ms";
        least_m = std::min(least_m, outcome.least_gap_m);
        followed_m = outcome.followed_at_m;
      }
      std::printf("%s: followed at %.1f m, least gap %.2f m\n", name_of(blind), followed_m, least_m);
    }
  }
}

struct Stand {
  double fastest_mps = 0.0;
  double least_gap_m = 1e3;
  double speed_mps = 0.0;  ///< after 20 s
};

/// At some 8 m/s a vehicle stands 25 m ahead; two lists say so, and then they go on, or stop.
Stand approach(bool lists_go_on) {
  const auto rig = std::make_unique<BasicRig<planner::Planner>>();
  EXPECT_EQ(rig->start(), Status::kOk);
  rig->plant.speed_mps = 6.0;
  rig->engage = true;
  EXPECT_GE(rig->until(Mode::kDriving), 0);
  rig->seconds(1.0);
  const Parameters parameters;
  const double to_front_m =
      static_cast<double>(parameters.vehicle.length_m - parameters.vehicle.rear_overhang_m);
  rig->track_list.count = 1;
  wire::Track& track = rig->track_list.items[0];
  track.id = 7;
  track.x_m = static_cast<float>(rig->plant.x_m + to_front_m + 25.0 + 0.5 * kLength_m);
  track.length_m = static_cast<float>(kLength_m);
  track.width_m = 1.8F;
  rig->seconds(0.2);
  rig->tracks = lists_go_on;
  Stand stand;
  for (int tick = 0; tick < 2000; ++tick) {
    rig->tick();
    const double gap_m = static_cast<double>(track.x_m) - 0.5 * kLength_m - rig->plant.x_m - to_front_m;
    stand.least_gap_m = std::min(stand.least_gap_m, gap_m);
    stand.fastest_mps = std::max(stand.fastest_mps, rig->plant.speed_mps);
  }
  stand.speed_mps = rig->plant.speed_mps;
  return stand;
}

// CORE-030: who stands ahead as lists stop is not forgotten: no faster than with lists, and 20 s later behind it.
TEST(BlindLeader, StandingAheadIsNotForgotten) {
  const Stand blind = approach(false);
  const Stand seeing = approach(true);
  EXPECT_LT(blind.speed_mps, 0.05);
  EXPECT_GT(blind.least_gap_m, 0.5);
  EXPECT_LT(blind.fastest_mps, seeing.fastest_mps + 0.05);
  std::printf(
      "25 m ahead stands a vehicle: up to %.2f m/s and %.2f m near without lists, %.2f m/s and %.2f m with "
      "them\n",
      blind.fastest_mps, blind.least_gap_m, seeing.fastest_mps, seeing.least_gap_m);
}

}  // namespace
}  // namespace s4tp::ecu
