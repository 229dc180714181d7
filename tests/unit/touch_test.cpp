// How likely a plan touches somebody whose future is known better in where than in when.

#include <gtest/gtest.h>

#include "algo/sadrf/overlap.hpp"

namespace s4tp::sadrf {
namespace {

/// We go along x, our box centre at x = 0 after 2 s, or stand there. The other has a box of 4 m by 2 m.
struct Meeting {
  Parameters parameters;
  Trajectory trajectory;
  satp::Mode mode;
  Track track;

  explicit Meeting(float own_mps = 10.0F) {
    parameters.scoring.timing_error = 0.15F;
    for (int i = 0; i < kTrajectoryPoints; ++i) {
      trajectory.points[i].rear_axle.x_m = own_mps * (kStepS * static_cast<float>(i) - 2.0F) - 1.5F;
      trajectory.points[i].speed_mps = own_mps;
    }
    track.length_m = 4.0F;
    track.width_m = 2.0F;
  }
  /// Up the y axis: at `y_m` after 3 s, at 5 m/s.
  float crossing(float y_m) {
    return with([&](float time_s) { return Pose{0.0F, y_m + 5.0F * (time_s - 3.0F), kUp}; });
  }
  /// Up the y axis, braking with 4 m/s^2 from 8 m/s on: it stands at `y_m` after 2 s.
  float stopping(float y_m) {
    return with([&](float time_s) {
      const float left_s = time_s < 2.0F ? 2.0F - time_s : 0.0F;
      return Pose{0.0F, y_m - 2.0F * left_s * left_s, kUp};
    });
  }
  /// Touches expected of one that drives through us at 10 m/s, from 15 m behind our middle and `left_m` beside it, and comes over to
  /// our way in 3 s.
  float expected(float left_m, bool conditioned) {
    const float behind_m = trajectory.points[0].rear_axle.x_m + 1.5F - 15.0F;
    scene::Scene scene;
    track.centre = {behind_m, left_m, 0.0F};
    scene::Agent agent;
    agent.track = track;
    (void)scene.agents.push(agent);
    (void)with([&](float time_s) {
      return Pose{behind_m + 10.0F * time_s, left_m * (1.0F - time_s / 3.0F), 0.0F};
    });
    satp::PredictionSet prediction;
    prediction.conditioned = conditioned;
    satp::AgentPrediction future;
    mode.probability = 0.5F;
    (void)future.modes.push(mode);
    (void)prediction.agents.push(future);
    WorkMeter work;
    return expected_collisions(scene, prediction, trajectory, parameters, work);
  }
  /// Along our way, ahead by `gap_m` between the bumpers.
  float ahead(float gap_m, float y_m, float speed_mps) {
    return with([&](float time_s) { return Pose{-20.0F + 4.5F + gap_m + speed_mps * time_s, y_m, 0.0F}; });
  }

 private:
  static constexpr float kUp = 1.5707963F;

  template <typename Place>
  float with(const Place& place) {
    for (int i = 0; i < kHorizonSteps; ++i) mode.steps[i] = place(kStepS * static_cast<float>(i + 1));
    satp::measure_steps(mode);
    return touch_likelihood(trajectory, mode, track, parameters);
  }
};

// We stand, one comes across: after 3 s it may be off by 0.15 * 3 s * 5 m/s = 2.25 m. Its front is 2 m ahead of its centre, our side
// 0.9 m from ours: with its centre at -2.9 it touches us for certain, half of 2.25 m short of that at one half, 2.3 m short not at all.
TEST(Touch, WhoCrossesMayBeSoonerThanExpected) {
  EXPECT_EQ(Meeting(0.0F).crossing(-2.89F), 1.0F);
  EXPECT_NEAR(Meeting(0.0F).crossing(-2.9F - 1.125F), 0.5F, 0.01F);
  EXPECT_EQ(Meeting(0.0F).crossing(-2.9F - 2.3F), 0.0F);
}

// One that brakes for our way is less off the slower it is: 0.3 m from our side it stands, and touches nobody. At x m from there it is
// off by 0.15 t sqrt(8 x) <= 0.85 sqrt(x) m, which is at most 0.18 m more than x.
TEST(Touch, WhoStopsBeforeOurWayIsNotFeared) {
  EXPECT_EQ(Meeting().stopping(-3.2F), 0.0F);
  EXPECT_EQ(Meeting().stopping(-2.8F), 1.0F);
}

// Off is when, not where: one that passes in the lane beside, 1.3 m from our side, touches nobody.
TEST(Touch, WhoDrivesBesideIsNotFeared) {
  EXPECT_EQ(Meeting().ahead(-4.0F, 3.2F, 15.0F), 0.0F);
  EXPECT_EQ(Meeting().ahead(2.0F, 1.8F, 5.0F), 1.0F);
}

// Ahead at our speed, 10 m/s: after 3 s it may be off by 4.5 m. 6 m ahead it is out of that, 1.5 m ahead it touches us at two thirds.
TEST(Touch, WhoLeadsMayBeSlowerThanExpected) {
  EXPECT_EQ(Meeting().ahead(6.0F, 0.0F, 10.0F), 0.0F);
  EXPECT_NEAR(Meeting().ahead(1.5F, 0.0F, 10.0F), 2.0F / 3.0F, 0.01F);
}

// With no error of timing a touch is one or none.
TEST(Touch, WithoutErrorOnlyBoxesCount) {
  Meeting meeting(0.0F);
  meeting.parameters.scoring.timing_error = 0.0F;
  EXPECT_EQ(meeting.crossing(-2.91F), 0.0F);
  EXPECT_EQ(meeting.crossing(-2.89F), 1.0F);
}

// Touching us from the first step on, as boxes of tracks may, it counts when 0.3 m deeper.
TEST(Touch, WhoTouchesAlreadyCountsWhenDeeper) {
  Meeting meeting;
  meeting.parameters.scoring.timing_error = 0.0F;
  EXPECT_EQ(meeting.ahead(-0.2F, 0.0F, 10.0F), 0.0F);
  EXPECT_EQ(meeting.ahead(-0.2F, 0.0F, 9.95F), 0.0F);
  EXPECT_EQ(meeting.ahead(-0.2F, 0.0F, 9.8F), 1.0F);
}

// Without our plan in it, a prediction has whoever follows us drive on as if we did, through us where we stand: with a probability of 0.5
// half a touch, and it counts only in a prediction on our plan. Drives fled from it past the last place for a lane change. One that
// comes over from the lane beside, 2.5 m from our middle and 1.6 m when it is here, half widths of 0.9 and 1 m, follows nobody.
TEST(Touch, WhoFollowsIsAskedOnlyWithOurPlan) {
  EXPECT_EQ(Meeting(0.0F).expected(0.0F, true), 0.5F);
  EXPECT_EQ(Meeting(0.0F).expected(0.0F, false), 0.0F);
  EXPECT_EQ(Meeting(0.0F).expected(2.5F, false), 0.5F);
}

}  // namespace
}  // namespace s4tp::sadrf
