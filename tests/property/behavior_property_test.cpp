// Manoeuvres in random drives: whatever plans are taken and wherever we are, only the tables' rows are followed.

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <memory>

#include "algo/behavior/manoeuvres.hpp"
#include "algo/planner/planner.hpp"
#include "tests/support/lane_change_road.hpp"
#include "tests/support/planner_drive.hpp"

namespace s4tp::behavior {
namespace {

using namespace test;  // NOLINT: the map builders are the language of these tests

template <class State, class Situation, int kRows>
bool in_table(const Transition<State, Situation> (&table)[kRows], State from, State to) {
  for (const auto& row : table) {
    if (row.from == from && row.to == to) return true;
  }
  return from == to;
}

/// What else has to hold of a state and the one before.
void check_step(const ManoeuvreState& before, const ManoeuvreState& after) {
  RC_ASSERT(in_table(kLaneChangeTable, before.lane_change, after.lane_change));
  RC_ASSERT(in_table(kRequiredChangeTable, before.required_change, after.required_change));
  RC_ASSERT(in_table(kZoneClaimTable, before.zone_claim, after.zone_claim));
  RC_ASSERT(is_known(after));
  RC_ASSERT((after.lane_change == LaneChange::kKeep) == (after.side == 0));
  // What has changed has been so since now.
  RC_ASSERT(before.lane_change == after.lane_change || after.lane_change_ms == 0);
  RC_ASSERT(before.required_change == after.required_change || after.required_change_ms == 0);
  RC_ASSERT(before.zone_claim == after.zone_claim || after.zone_claim_ms == 0);
}

// BEHAV-001: 60 plans taken one after the other, each along any path, with any speeds and a fail-safe that passes or not,
// while we are anywhere on either of two lanes with zones ahead or none.
TEST(BehaviorProperty, OnlyRowsOfTheTables) {
  EXPECT_TRUE(rc::check([] {
    const auto road = std::make_unique<LaneChangeRoad>();
    scene::Scene& scene = road->scene;
    ManoeuvreState state;
    for (int taken = 0; taken < 60; ++taken) {
      const int under = *rc::gen::inRange(0, 2);
      scene.ego_paths.clear();
      scene::EgoPath& own =
          add_ego_path(scene, road->map, path_of(road->map, {static_cast<LaneIndex>(under)}));
      need_changes(own, *rc::gen::inRange(-1, 2), static_cast<float>(*rc::gen::inRange(50, 100)));
      if (*rc::gen::arbitrary<bool>())
        (void)own.zones.push({60.0F, 64.0F, 55.0F, static_cast<LaneIndex>(*rc::gen::inRange(3, 5))});
      const auto beside = under == 0 ? scene::Manoeuvre::kLeft : scene::Manoeuvre::kRight;
      add_ego_path(scene, road->map, path_of(road->map, {static_cast<LaneIndex>(1 - under)}), beside);
      const float d_m = 0.01F * static_cast<float>(*rc::gen::inRange(-160, 161));
      const float speed_mps = static_cast<float>(*rc::gen::inRange(0, 12));
      TrajectoryPoint start = state_on(road->map, scene.ego_paths[0].path, 50.0F, speed_mps, d_m);
      start.rear_axle.heading_rad = 0.01F * static_cast<float>(*rc::gen::inRange(-20, 21));
      put_ego(scene, start);
      const Trajectory trajectory = across(start, 0.0F, 0.0F);
      const PlanTaken plan{*rc::gen::inRange(0, 2), &trajectory, *rc::gen::arbitrary<bool>(),
                           *rc::gen::inRange(0, 3)};
      pass_time(100, state);
      ManoeuvreState next = state;
      advance(plan, scene, road->parameters, next);
      check_step(state, next);
      const int on = leads_to(next, scene);
      RC_ASSERT(on >= 0 && on < scene.ego_paths.size());
      state = next;
    }
  }));
}

// BEHAV-001: a planner among others that come and go; where no plan is taken, because nothing was tried, the list is stale
// or the map is gone, the state is that of the plan before, a cycle older.
TEST(BehaviorProperty, WhatIsRefusedChangesNothing) {
  EXPECT_TRUE(rc::check([] {
    PlannerDrive drive = on_straight_road(static_cast<float>(*rc::gen::inRange(0, 13)));
    for (int i = 0; i < 3; ++i) {
      Track track;
      track.id = static_cast<std::uint8_t>(i + 1);
      track.centre = {static_cast<float>(*rc::gen::inRange(30, 120)),
                      kLaneWidthM * static_cast<float>(*rc::gen::inRange(0, 3)), 0.0F};
      track.speed_mps = static_cast<float>(*rc::gen::inRange(0, 12));
      track.length_m = 5.0F;
      track.width_m = 1.8F;
      (void)drive.input.tracks.push(track);
    }
    for (int cycle = 0; cycle < 20; ++cycle) {
      drive.planner->allowance.candidates = *rc::gen::inRange(0, 4) == 0 ? 0 : kMaxCandidates;
      drive.has_map = *rc::gen::inRange(0, 8) != 0;
      const ManoeuvreState before = drive.running.manoeuvre;
      const bool taken = drive.step() == Status::kOk;
      const ManoeuvreState& after = drive.running.manoeuvre;
      check_step(before, after);
      if (taken) continue;
      RC_ASSERT(after.lane_change == before.lane_change && after.side == before.side);
      RC_ASSERT(after.required_change == before.required_change && after.zone_claim == before.zone_claim);
      RC_ASSERT(after.zone_lane == before.zone_lane);
    }
  }));
}

}  // namespace
}  // namespace s4tp::behavior
