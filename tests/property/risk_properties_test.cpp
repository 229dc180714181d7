// What must hold for the risk of any scene.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "algo/core/math.hpp"
#include "algo/sadrf/risk.hpp"
#include "tests/support/risk_worlds.hpp"

namespace s4tp {
namespace {

using test::random_world;
using World = test::RiskWorld;

/// A move of the plane: rotation about the origin, then a shift; or a mirroring of left and right.
struct Move {
  float angle_rad = 0.0F;
  Point shift;
  bool mirrored = false;

  [[nodiscard]] Point operator()(Point point) const {
    const Point side = {point.x_m, mirrored ? -point.y_m : point.y_m};
    return offset_point({shift.x_m, shift.y_m, angle_rad}, side.x_m, side.y_m);
  }
  [[nodiscard]] Pose operator()(const Pose& pose) const {
    const Point moved = (*this)(position(pose));
    return {moved.x_m, moved.y_m, wrap_angle((mirrored ? -pose.heading_rad : pose.heading_rad) + angle_rad)};
  }
};

std::unique_ptr<World> moved(const World& original, const Move& move) {
  auto world = std::make_unique<World>(original);
  for (TrajectoryPoint& point : world->trajectory.points) {
    point.rear_axle = move(point.rear_axle);
    if (move.mirrored) point.curvature_1pm = -point.curvature_1pm;
  }
  for (Lane& lane : world->map.lanes) {
    for (Point& point : lane.points) point = move(point);
  }
  for (scene::Agent& agent : world->scene.agents) agent.track.centre = move(agent.track.centre);
  for (satp::Mode& mode : world->others.agents) {
    for (Pose& step : mode.steps) step = move(step);
  }
  for (satp::AgentPrediction& of : world->prediction.agents) {
    for (satp::Mode& mode : of.modes) {
      for (Pose& step : mode.steps) step = move(step);
    }
  }
  return world;
}

sadrf::RiskProfile exact(const World& world) {
  sadrf::DrivableArea area;
  sadrf::build_drivable(&world.map, area);
  sadrf::RiskProfile profile;
  sadrf::exact_risk(world.scene, area, world.prediction, world.others, world.trajectory, world.parameters,
                    profile);
  return profile;
}

constexpr float (sadrf::RiskProfile::*kParts[])[kHorizonSteps] = {
    &sadrf::RiskProfile::obstacle, &sadrf::RiskProfile::social, &sadrf::RiskProfile::road};

/// Whether every part of every step lies between those, but for 2 % and what is nothing beside a threshold of thousands.
bool lies_between(const sadrf::RiskProfile& least, const sadrf::RiskProfile& risk,
                  const sadrf::RiskProfile& most) {
  for (const auto part : kParts) {
    for (int i = 0; i < kHorizonSteps; ++i) {
      const float value = (risk.*part)[i];
      if (value < 0.98F * (least.*part)[i] - 5.0F || 0.98F * value > (most.*part)[i] + 5.0F) return false;
    }
  }
  return true;
}

/// Whether that is the risk of `world`. From some angle or risk on a box is integrated in another way, and rounding falls on
/// either side of that: what our car comes to a tenth of a millimetre or 0.00003 rad off is as good.
bool is_risk_of(const World& world, const sadrf::RiskProfile& risk) {
  sadrf::RiskProfile least = exact(world);
  sadrf::RiskProfile most = least;
  for (int nudge = 0; nudge < 16 && !lies_between(least, risk, most); ++nudge) {
    const Point aside = 1e-4F * direction(kTwoPi / 16.0F * static_cast<float>(nudge));
    auto nudged = std::make_unique<World>(world);
    for (TrajectoryPoint& point : nudged->trajectory.points) {
      point.rear_axle.x_m += aside.x_m;
      point.rear_axle.y_m += aside.y_m;
      point.rear_axle.heading_rad += 2e-5F * (static_cast<float>(nudge % 4) - 1.5F);
    }
    const sadrf::RiskProfile there = exact(*nudged);
    for (const auto part : kParts) {
      for (int i = 0; i < kHorizonSteps; ++i) {
        (least.*part)[i] = std::min((least.*part)[i], (there.*part)[i]);
        (most.*part)[i] = std::max((most.*part)[i], (there.*part)[i]);
      }
    }
  }
  return lies_between(least, risk, most);
}

/// Turned and shifted, by amounts that follow from the seed.
bool moves_change_nothing(unsigned seed) {
  const auto world = random_world(seed);
  const Move move = {static_cast<float>(seed % 628U) * 0.01F - 3.14F,
                     {static_cast<float>(seed % 401U) - 200.0F, static_cast<float>(seed % 307U) - 150.0F}};
  return is_risk_of(*world, exact(*moved(*world, move)));
}

}  // namespace

// CORE-062: turning and shifting the whole world changes nothing.
TEST(RiskProperties, InvariantUnderMoves) {
  EXPECT_TRUE(rc::check([](unsigned seed) { RC_ASSERT(moves_change_nothing(seed)); }));
}

// The same of worlds in which rounding falls on the other side of a change of method: one in 50,000.
TEST(RiskProperties, InvariantUnderMovesWhereTheMethodChanges) {
  for (const unsigned seed : {14799U, 34087U, 50873U, 73613U, 97799U, 142286U})
    EXPECT_TRUE(moves_change_nothing(seed)) << "world " << seed;
}

// CORE-062: in the mirror left is right and the risk is the same.
TEST(RiskProperties, MirroredWorldMirroredRisk) {
  EXPECT_TRUE(rc::check([](unsigned seed) {
    const auto world = random_world(seed);
    Move mirror;
    mirror.mirrored = true;
    RC_ASSERT(is_risk_of(*world, exact(*moved(*world, mirror))));
  }));
}

// CORE-062 CORE-063: every part of every step is finite and not negative, and so is the ranking value.
TEST(RiskProperties, NeverNegative) {
  EXPECT_TRUE(rc::check([](unsigned seed) {
    const auto world = random_world(seed);
    const sadrf::RiskProfile profile = exact(*world);
    for (int i = 0; i < kHorizonSteps; ++i) {
      for (const float part : {profile.obstacle[i], profile.road[i], profile.social[i]}) {
        RC_ASSERT(is_finite(part) && part >= 0.0F);
      }
    }
    sadrf::DrivableArea area;
    sadrf::build_drivable(&world->map, area);
    WorkMeter work{1'000'000};
    const float rank = sadrf::rank_risk_of_vehicles(world->scene, world->prediction, world->others,
                                                    world->trajectory, world->parameters, work) +
                       sadrf::rank_risk_of_road(area, world->trajectory, world->parameters, work);
    RC_ASSERT(is_finite(rank) && rank >= 0.0F);
  }));
}

// CORE-062: whoever is 200 m away is neither in our field nor has us in theirs, wherever they look.
TEST(RiskProperties, FarAwayIsNoRisk) {
  EXPECT_TRUE(rc::check([](unsigned seed) {
    auto world = random_world(seed);
    const Move away = {0.0F, {200.0F, -200.0F}};
    const auto others = moved(*world, away);
    world->others = others->others;
    world->prediction = others->prediction;
    const sadrf::RiskProfile profile = exact(*world);
    for (int i = 0; i < kHorizonSteps; ++i) RC_ASSERT(profile.obstacle[i] + profile.social[i] == 0.0F);
    RC_ASSERT(profile.dominating_agent == 255);
  }));
}

// CORE-062: one vehicle more never makes the obstacle part smaller (vehicles cover, they do not cancel).
TEST(RiskProperties, OneMoreVehicleIsNotLessRisk) {
  EXPECT_TRUE(rc::check([](unsigned seed) {
    const auto world = random_world(seed);
    const sadrf::RiskProfile all = exact(*world);
    if (world->scene.agents.size() < 4) return;
    world->scene.agents.truncate(world->scene.agents.size() - 1);
    const sadrf::RiskProfile fewer = exact(*world);
    for (int i = 0; i < kHorizonSteps; ++i) RC_ASSERT(all.obstacle[i] >= 0.999F * fewer.obstacle[i] - 1.0F);
  }));
}

}  // namespace s4tp
