// What a plan's explanation reads like, for explanations made by hand.

#include "sim_host/view/plan_words.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "sim_host/view/plan_numbers.hpp"

namespace s4tp::view {
namespace {

/// A plan from `start_mps` to `end_mps` along x.
campaign::CycleTrace plan(float start_mps, float end_mps, double at_s = 0.0) {
  campaign::CycleTrace cycle;
  cycle.record.plan.kind = PlanKind::kDrive;
  cycle.record.plan.start_ms = static_cast<std::uint32_t>(std::lround(1000.0 * at_s));
  for (int i = 0; i < kTrajectoryPoints; ++i) {
    cycle.record.plan.trajectory.points[i].speed_mps =
        start_mps + (end_mps - start_mps) * static_cast<float>(i) / kHorizonSteps;
  }
  return cycle;
}

void add_track(campaign::CycleTrace& cycle, std::uint8_t id, Pose centre, float length_m = 5.0F) {
  Track track;
  track.id = id;
  track.centre = centre;
  track.speed_mps = 8.0F;
  track.length_m = length_m;
  track.width_m = 1.8F;
  cycle.tracks.push_back(track);
}

void block(campaign::CycleTrace& cycle, safety::Cause cause, std::uint8_t track, float from_s = 0.0F,
           float needed_s = 0.0F) {
  planner::BlockingReason& blocking = cycle.record.explanation.blocking;
  blocking.verdict = {cause, 0, from_s, needed_s};
  blocking.track = track;
  blocking.way_m = 40.0F;
}

constexpr float kFromLeft = -1.57F;  // it drives to our right

// Nothing in the way: what the car does is said, and no reason made up.
TEST(PlanWords, FreeRoadNeedsNoReason) {
  EXPECT_EQ(in_words(plan(10.0F, 10.0F)), "Driving on.");
  EXPECT_EQ(in_words(plan(8.0F, 12.0F)), "Speeding up.");
  EXPECT_EQ(in_words(plan(12.0F, 8.0F)), "Slowing down.");
  EXPECT_EQ(in_words(plan(5.0F, 0.0F)), "Coming to a halt.");
  EXPECT_EQ(in_words(plan(0.0F, 3.0F)), "Setting off.");
  EXPECT_EQ(in_words(plan(0.0F, 0.0F)), "Waiting.");
}

// CORE-037 Whoever is not told of is called so: on ground we share, ahead, in the lane beside, and in the numbers.
TEST(PlanWords, NamesWhoIsNotToldOf) {
  campaign::CycleTrace cycle = plan(0.0F, 0.0F);
  block(cycle, safety::Cause::kZone, 255, 3.2F, 4.1F);
  planner::BlockingReason& blocking = cycle.record.explanation.blocking;
  blocking.verdict.agent = safety::kUnseen;
  cycle.record.explanation.tracks_left_out = 4;
  EXPECT_EQ(in_words(cycle),
            "Waiting: somebody we are not told of can be there in 3.2 s, we would need 4.1 s.");
  EXPECT_NE(in_numbers(cycle).find("zone, 40.0 m wanted, somebody we are not told of, there in 3.2 s"),
            std::string::npos);
  EXPECT_NE(in_numbers(cycle).find("not told of: 4 vehicles, 0 lanes"), std::string::npos);
  blocking.verdict.cause = safety::Cause::kLeader;
  EXPECT_EQ(in_words(cycle), "Waiting: somebody we are not told of may stand ahead.");
}

// Giving way: to whom, when they can be there, and how long we would need.
TEST(PlanWords, WaitingForACrossingCar) {
  campaign::CycleTrace cycle = plan(0.0F, 0.0F);
  add_track(cycle, 7, {15.0F, 20.0F, kFromLeft});
  block(cycle, safety::Cause::kZone, 7, 3.2F, 4.1F);
  EXPECT_EQ(in_words(cycle), "Waiting: the car from the left can be there in 3.2 s, we would need 4.1 s.");
  block(cycle, safety::Cause::kZone, 7, 0.0F, 4.1F);
  EXPECT_EQ(in_words(cycle), "Waiting: the car from the left is in our way.");
}

// Vehicles are named by where they are from our seat and by their size; who is not seen is somebody.
TEST(PlanWords, NamesVehiclesByPlaceAndSize) {
  const struct {
    Pose centre;
    float length_m;
    const char* name;
  } kCases[] = {
      {{20.0F, 0.5F, 0.0F}, 5.0F, "the car ahead"},
      {{-20.0F, 0.5F, 0.0F}, 12.0F, "the truck behind"},
      {{20.0F, 3.2F, 0.1F}, 5.0F, "the car ahead on the left"},
      {{1.0F, -3.2F, 0.0F}, 6.5F, "the van beside us on the right"},
      {{40.0F, 3.5F, 3.1F}, 5.0F, "the oncoming car"},
      {{15.0F, -20.0F, 1.57F}, 5.0F, "the car from the right"},
  };
  for (const auto& given : kCases) {
    campaign::CycleTrace cycle = plan(5.0F, 2.0F);
    add_track(cycle, 7, given.centre, given.length_m);
    block(cycle, safety::Cause::kZone, 7);
    EXPECT_EQ(in_words(cycle), std::string("Slowing down: ") + given.name + " is in our way.");
    block(cycle, safety::Cause::kZone, 8);
    EXPECT_EQ(in_words(cycle), "Slowing down: somebody is in our way.");
  }
}

// Each cause has its words.
TEST(PlanWords, EveryCauseHasWords) {
  const struct {
    safety::Cause cause;
    const char* words;
  } kCases[] = {
      {safety::Cause::kRoadEnd, "Slowing down: our lane ends ahead."},
      {safety::Cause::kNoRoom,
       "Slowing down: beyond the junction there is no room, and it must not be blocked."},
      {safety::Cause::kLeader, "Slowing down: the car ahead leaves no more room."},
      {safety::Cause::kFollower, "Slowing down: the car ahead would have to brake hard for us."},
  };
  for (const auto& given : kCases) {
    campaign::CycleTrace cycle = plan(8.0F, 5.0F);
    add_track(cycle, 7, {20.0F, 0.0F, 0.0F});
    block(cycle, given.cause, 7);
    EXPECT_EQ(in_words(cycle), given.words);
  }
}

// A motion that would have gone hardly further than the plan holds nobody up: 30 steps at 10 m/s are 31 m, 32
// m were wanted.
TEST(PlanWords, HardlyFurtherIsNoReason) {
  campaign::CycleTrace cycle = plan(10.0F, 10.0F);
  block(cycle, safety::Cause::kRoadEnd, 255);
  cycle.record.explanation.blocking.way_m = 32.0F;
  EXPECT_EQ(in_words(cycle), "Driving on.");
}

// Following somebody slower: how far away, and why we do not pass.
TEST(PlanWords, FollowingAndNotPassing) {
  campaign::CycleTrace cycle = plan(8.0F, 8.0F);
  add_track(cycle, 7, {20.0F, 0.0F, 0.0F});
  add_track(cycle, 9, {-12.0F, 3.2F, 0.0F});
  planner::Explanation& e = cycle.record.explanation;
  e.chosen.intent = trajectory::Intent::kFollow;
  e.leader_track = 7;
  e.leader_gap_m = 13.4F;
  EXPECT_EQ(in_words(cycle), "Driving on: the car ahead is 13 m away.");
  e.beside = {{safety::Cause::kFollower, 1}, 9, scene::Manoeuvre::kLeft, 40.0F};
  EXPECT_EQ(in_words(cycle),
            "Driving on: the car ahead is 13 m away. No change to the left: the car behind on the left would "
            "have to "
            "brake hard for us.");
}

// A bend, a risk avoided.
TEST(PlanWords, OtherReasonsToSlowDown) {
  campaign::CycleTrace bend = plan(8.0F, 6.0F);
  bend.record.plan.trajectory.points[20].curvature_1pm = 0.05F;  // at 6.7 m/s: 2.2 m/s^2
  EXPECT_EQ(in_words(bend), "Slowing down: a bend.");

  campaign::CycleTrace risky = plan(8.0F, 6.0F);
  add_track(risky, 7, {20.0F, 3.2F, 0.0F});
  planner::Explanation& e = risky.record.explanation;
  e.dominating_track = 7;
  e.chosen_cost.progress = -20.0F;
  e.runner_up_cost.progress = -25.0F;
  e.runner_up_cost.risk = 9.0F;
  EXPECT_EQ(in_words(risky),
            "Slowing down: going on faster would be risky because of the car ahead on the left.");
}

// Lane changes are named, minimum-risk manoeuvres say what was wrong.
TEST(PlanWords, LaneChangesAndStops) {
  campaign::CycleTrace change = plan(10.0F, 10.0F);
  change.record.explanation.manoeuvre = scene::Manoeuvre::kLeft;
  EXPECT_EQ(in_words(change), "Changing to the left lane.");

  campaign::CycleTrace stop = plan(10.0F, 0.0F);
  stop.record.plan.kind = PlanKind::kMinimumRisk;
  stop.record.explanation.status = Status::kNoLane;
  EXPECT_EQ(in_words(stop), "Stopping to be safe: no lane can be seen under us.");
  stop.record.explanation.status = Status::kInvalidInput;
  EXPECT_EQ(in_words(stop), "Stopping to be safe: what the sensors say cannot be right.");
  stop.record.explanation.status = Status::kStaleTracks;
  EXPECT_EQ(in_words(stop), "Stopping to be safe: the sensors have not said for too long who is around.");
  stop.record.explanation.status = Status::kNoSafePlan;
  add_track(stop, 7, {15.0F, 20.0F, kFromLeft});
  block(stop, safety::Cause::kZone, 7, 1.0F, 3.0F);
  EXPECT_EQ(in_words(stop),
            "Stopping to be safe: no way on is safe enough; the car from the left can be there in 1.0 s, we "
            "would need "
            "3.0 s.");
}

// An ECU that stops, or has stopped, for a fault says so, whatever plans are still made; and which fault, also when it is
// gone again.
TEST(PlanWords, TheEcusFaultComesFirst) {
  campaign::CycleTrace cycle = plan(0.0F, 3.0F);
  const auto lost = static_cast<ecu::Faults>(ecu::FaultBit::kMapLost);
  EXPECT_EQ(in_words(cycle), "Setting off.");
  cycle.ecu.change(
      {0, ecu::Mode::kDriving, ecu::Mode::kMinimumRisk, ecu::TransitionId::kDrivingMinimumRisk, lost});
  EXPECT_EQ(in_words(cycle),
            "Stopping to be safe: the ECU found a fault (no map) and no longer follows the planner.");
  cycle.ecu.change(
      {0, ecu::Mode::kMinimumRisk, ecu::Mode::kStopped, ecu::TransitionId::kMinimumRiskStopped, 0});
  EXPECT_EQ(in_words(cycle),
            "Stopped to be safe: the ECU found a fault (no map) and stands until the driver takes over.");
  cycle.ecu.change({0, ecu::Mode::kStopped, ecu::Mode::kFault, ecu::TransitionId::kStoppedFault,
                    static_cast<ecu::Faults>(ecu::FaultBit::kSelfTest)});
  EXPECT_EQ(in_words(cycle), "Out of order: the ECU found a fault (self-test refused) and cannot drive.");
  cycle.ecu.change({0, ecu::Mode::kStopped, ecu::Mode::kStandby, ecu::TransitionId::kStoppedStandby, 0});
  EXPECT_EQ(in_words(cycle), "Setting off.");
}

// The numbers name what an engineer asks first: costs, rejections, whose risk and when, RSS, work.
TEST(PlanWords, NumbersForAnEngineer) {
  campaign::CycleTrace cycle = plan(8.0F, 5.0F);
  add_track(cycle, 7, {20.0F, 0.0F, 0.0F});
  planner::Explanation& e = cycle.record.explanation;
  e.candidate_count = 4;
  e.decisions = 2;
  e.rejections[0] = e.rejections[1] = trajectory::Rejection::kRefused;
  e.rejections[2] = trajectory::Rejection::kInfeasible;
  e.chosen_cost.progress = -20.0F;
  e.chosen_cost.risk = 2.5F;
  e.runner_up_cost.progress = -15.0F;
  e.runner_up_manoeuvre = scene::Manoeuvre::kRight;
  e.dominating_track = 7;
  e.dominating_step = 11;
  e.work[static_cast<int>(planner::Stage::kPredict)] = 150;
  const std::string numbers = in_numbers(cycle);
  for (const char* part :
       {"cost -17.5 = progress -20.0", "risk 2.5", "runner-up: right", "cost -15.0",
        "of 4: 1 infeasible, 2 refused by the guard", "track 7 (the car ahead) at +1.2 s", "predict 150"}) {
    EXPECT_NE(numbers.find(part), std::string::npos) << part << "\n" << numbers;
  }
}

// What was decided, and for how long it has been so; of what was not decided nothing is said.
TEST(PlanWords, SaysWhatWasDecided) {
  campaign::CycleTrace cycle = plan(8.0F, 8.0F);
  EXPECT_EQ(in_numbers(cycle).find("manoeuvre:"), std::string::npos);
  cycle.record.plan.manoeuvre = {
      LaneChange::kCrossing, -1, RequiredChange::kApproaching, ZoneClaim::kCommitted, 800, 5000, 100, 0};
  EXPECT_NE(
      in_numbers(cycle).find("manoeuvre: change to the right crossing for 0.8 s; required change approaching "
                             "its last place for 5.0 s; zones ahead committed to for 0.1 s"),
      std::string::npos)
      << in_numbers(cycle);
}

// What the plan rests on: whoever is expected to let us pass is named with how likely that is, when we go; the numbers
// name the other future, too, and who predicted it.
TEST(PlanWords, SaysWhichFutureThePlanRestsOn) {
  campaign::CycleTrace cycle = plan(5.0F, 8.0F);
  add_track(cycle, 7, {15.0F, 20.0F, kFromLeft});
  planner::Explanation& e = cycle.record.explanation;
  e.dominating_track = 7;
  e.learned = true;
  e.rests_on = {true, 0.83F, 0.5F};
  EXPECT_EQ(in_words(cycle), "Speeding up. It counts on the car from the left letting us pass (83 %).");
  EXPECT_NE(in_numbers(cycle).find(
                "rests on:  track 7 (the car from the left) letting us pass, 83 %; predicted by the "
                "network, trusted to 50 %"),
            std::string::npos)
      << in_numbers(cycle);
  e.learned = false;
  e.rests_on.yields = false;
  EXPECT_EQ(in_words(cycle), "Speeding up.");
  EXPECT_NE(in_numbers(cycle).find("not braking for us, 83 %; predicted by the kinematic model"),
            std::string::npos);
  e.rests_on = {};
  EXPECT_EQ(in_numbers(cycle).find("rests on"), std::string::npos);
}

// Ten plans: before the episode's start nothing, then 0.5 s of driving with one plan of waiting in between,
// which is too brief, then 0.4 s of waiting.
TEST(PlanWords, PassagesJoinPlansWithTheSameReason) {
  campaign::Trace trace;
  trace.cycles.push_back(plan(0.0F, 0.0F, 1.9));
  for (int i = 0; i < 9; ++i) {
    const bool waits = i == 2 || i >= 5;
    trace.cycles.push_back(plan(waits ? 0.0F : 10.0F, waits ? 0.0F : 10.0F, 2.0 + 0.1 * i));
  }
  const std::vector<ReasonSpan> found = reason_spans(trace, 2.0);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].words, "Driving on.");
  EXPECT_NEAR(found[0].from_s, 0.0, 1e-6);
  EXPECT_NEAR(found[0].to_s, 0.5, 1e-6);
  EXPECT_EQ(found[1].words, "Waiting.");
  EXPECT_NEAR(found[1].to_s, 0.9, 1e-6);
  std::ostringstream printed;
  print_reason_spans(printed, trace, 2.0);
  EXPECT_NE(printed.str().find("0.5 ..   0.9 s  Waiting."), std::string::npos) << printed.str();
}

}  // namespace
}  // namespace s4tp::view
