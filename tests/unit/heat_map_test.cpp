#include "algo/sadrf/heat_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "algo/core/math.hpp"

namespace s4tp::sadrf {
namespace {

struct Picture {
  scene::Scene scene;
  LaneMap lanes;
  DrivableArea area;
  satp::PredictionSet prediction;
  satp::KinematicSet others;
  HeatMap map;

  /// A car of 4 x 2 m, straight on along its heading.
  void add_car(const Pose& centre, float speed_mps) {
    scene::Agent agent;
    agent.track.centre = centre;
    agent.track.length_m = 4.0F;
    agent.track.width_m = 2.0F;
    EXPECT_TRUE(scene.agents.push(agent));
    satp::Mode mode;
    for (int i = 0; i < kHorizonSteps; ++i) {
      mode.steps[i] = shift_ahead(centre, speed_mps * kStepS * static_cast<float>(i + 1));
    }
    EXPECT_TRUE(others.agents.push(mode));
  }

  void draw() {
    build_drivable(&lanes, area);
    for (int row = 0; row < kHeatRows; ++row) {
      heat_row(scene, area, prediction, others, Parameters{}, row, map);
    }
  }

  /// The cell that holds a point of our own frame.
  [[nodiscard]] int at(float x_m, float y_m) const {
    return map.cells[static_cast<int>(std::floor(y_m)) + kHeatRows / 2]
                    [static_cast<int>(std::floor(x_m)) + kHeatBehind];
  }
};

std::unique_ptr<Picture> two_way_road() {
  auto picture = std::make_unique<Picture>();
  for (int k = 0; k < 2; ++k) {
    Lane& lane = picture->lanes.lanes[k];
    lane.present = true;
    lane.kind = k == 0 ? LaneKind::kOurs : LaneKind::kOpposite;
    lane.width_m = 4.0F;
    lane.point_count = 2;
    lane.points[0] = {-100.0F, 4.0F * static_cast<float>(k)};
    lane.points[1] = {200.0F, 4.0F * static_cast<float>(k)};
  }
  return picture;
}

}  // namespace

// CORE-064: an empty road: 0 on our lane (y = -2 .. 2), the opposite one to its left, no road beyond.
TEST(HeatMap, GroundOfAnEmptyRoad) {
  const auto picture = two_way_road();
  picture->draw();
  EXPECT_EQ(picture->at(10.5F, 0.5F), 0);
  EXPECT_EQ(picture->at(10.5F, 3.5F), kHeatOpposite);
  EXPECT_EQ(picture->at(10.5F, 8.5F), kHeatOffRoad);
  EXPECT_EQ(picture->at(10.5F, -4.5F), kHeatOffRoad);
}

// CORE-064: a car 20 m ahead is drawn where it is; its risk lies ahead of it, falls with distance, and none
// behind.
TEST(HeatMap, RiskLiesAheadOfAVehicle) {
  const auto picture = two_way_road();
  picture->add_car({20.0F, 0.0F, 0.0F}, 8.0F);
  picture->draw();
  EXPECT_EQ(picture->at(20.5F, 0.5F), kHeatVehicle);
  EXPECT_EQ(picture->at(18.5F, -0.5F), kHeatVehicle);
  EXPECT_EQ(picture->at(16.5F, 0.5F), 0);
  EXPECT_GT(picture->at(30.5F, 0.5F), 20);
  EXPECT_LE(picture->at(30.5F, 0.5F), kHeatHighest);
  EXPECT_GT(picture->at(30.5F, 0.5F), picture->at(48.5F, 0.5F));
}

// CORE-064: three quarters of the picture lie ahead of us, in our frame: turned by 90 degrees, a car on our
// +y axis in the world (ahead of us) is ahead in the picture.
TEST(HeatMap, IsInOurFrame) {
  Picture picture;
  picture.scene.ego.rear_axle = {100.0F, 50.0F, 0.5F * kPi};
  picture.add_car({100.0F, 140.0F, 0.5F * kPi}, 0.0F);
  picture.draw();
  EXPECT_EQ(picture.at(90.5F, 0.5F), kHeatVehicle);
  EXPECT_EQ(kHeatColumns - kHeatBehind, 3 * kHeatColumns / 4);
}

}  // namespace s4tp::sadrf
