#include "algo/sadrf/drivable.hpp"

#include <gtest/gtest.h>

#include <memory>

namespace s4tp::sadrf {
namespace {

void add_lane(LaneMap& map, int index, LaneKind kind, bool in_junction, Point from, Point to) {
  Lane& lane = map.lanes[index];
  lane.present = true;
  lane.kind = kind;
  lane.in_junction = in_junction;
  lane.width_m = 3.0F;
  lane.point_count = 2;
  lane.points[0] = from;
  lane.points[1] = to;
}

/// A crossing of two two-way roads, 20 x 20 m, with straight lanes through it.
std::unique_ptr<LaneMap> crossing() {
  auto map = std::make_unique<LaneMap>();
  add_lane(*map, 0, LaneKind::kOurs, false, {-60.0F, -1.5F}, {-10.0F, -1.5F});
  add_lane(*map, 1, LaneKind::kOurs, true, {-10.0F, -1.5F}, {10.0F, -1.5F});
  add_lane(*map, 2, LaneKind::kOurs, false, {10.0F, -1.5F}, {60.0F, -1.5F});
  add_lane(*map, 3, LaneKind::kOpposite, false, {60.0F, 1.5F}, {10.0F, 1.5F});
  add_lane(*map, 4, LaneKind::kOpposite, true, {10.0F, 1.5F}, {-10.0F, 1.5F});
  add_lane(*map, 5, LaneKind::kOpposite, false, {-10.0F, 1.5F}, {-60.0F, 1.5F});
  add_lane(*map, 6, LaneKind::kOurs, true, {1.5F, -10.0F}, {1.5F, 10.0F});
  add_lane(*map, 7, LaneKind::kOurs, true, {-1.5F, 10.0F}, {-1.5F, -10.0F});
  add_lane(*map, 8, LaneKind::kShoulder, false, {-60.0F, -4.5F}, {-10.0F, -4.5F});
  return map;
}

}  // namespace

// CORE-061: our lane is free, the opposite one is told apart, shoulder and meadow are off the road.
TEST(Drivable, LanesByKind) {
  const auto map = crossing();
  const auto area = std::make_unique<DrivableArea>();
  build_drivable(map.get(), *area);
  EXPECT_EQ(ground_at(*area, {-40.0F, -1.5F}), Ground::kOurs);
  EXPECT_EQ(ground_at(*area, {-40.0F, 1.5F}), Ground::kOpposite);
  EXPECT_EQ(ground_at(*area, {-40.0F, -4.5F}), Ground::kOffRoad);
  EXPECT_EQ(ground_at(*area, {-40.0F, 3.2F}), Ground::kOffRoad);
  EXPECT_EQ(ground_at(*area, {-40.0F, 2.8F}), Ground::kOpposite);
}

// CORE-061: in the junction the hull of its lanes is ours: opposite lanes and the asphalt between lanes that
// cross; (5, 5) lies inside the octagon through (10, 3) and (3, 10), (8, 8) outside.
TEST(Drivable, JunctionIsTheHullOfItsLanes) {
  const auto map = crossing();
  const auto area = std::make_unique<DrivableArea>();
  build_drivable(map.get(), *area);
  ASSERT_EQ(area->junctions.size(), 1);
  EXPECT_EQ(area->junctions[0].hull.size(), 8);
  EXPECT_EQ(ground_at(*area, {0.0F, 1.5F}), Ground::kOurs);
  EXPECT_EQ(ground_at(*area, {5.0F, 5.0F}), Ground::kOurs);
  EXPECT_EQ(ground_at(*area, {-5.0F, -6.0F}), Ground::kOurs);
  EXPECT_EQ(ground_at(*area, {8.0F, 8.0F}), Ground::kOffRoad);
}

// CORE-061: two junctions apart are two hulls; the meadow between them stays a meadow.
TEST(Drivable, JunctionsApartStayApart) {
  const auto map = crossing();
  add_lane(*map, 10, LaneKind::kOurs, true, {60.0F, -1.5F}, {80.0F, -1.5F});
  add_lane(*map, 11, LaneKind::kOurs, true, {70.0F, -10.0F}, {70.0F, 10.0F});
  const auto area = std::make_unique<DrivableArea>();
  build_drivable(map.get(), *area);
  EXPECT_EQ(area->junctions.size(), 2);
  EXPECT_EQ(ground_at(*area, {40.0F, 6.0F}), Ground::kOffRoad);
}

// Across the two-way road, 4 m to each side of our centre line: ours is [-1.5, 1.5], drivable [-1.5, 4].
TEST(Drivable, CrossSectionIsTheUnionOfStrips) {
  const auto map = crossing();
  const auto area = std::make_unique<DrivableArea>();
  build_drivable(map.get(), *area);
  Bounds path;
  include(path, {-40.0F, -1.5F});
  NearStrips near;
  near_strips(*area, path, 4.0F, near);
  CrossSection section;
  WorkMeter work{1'000'000};
  cross_section(*area, near, {-40.0F, -1.5F, 0.0F}, 4.0F, section, work);
  ASSERT_EQ(section.ours.size(), 1);
  EXPECT_NEAR(section.ours[0].right_m, -1.5F, 1e-4F);
  EXPECT_NEAR(section.ours[0].left_m, 1.5F, 1e-4F);
  ASSERT_EQ(section.drivable.size(), 1);
  EXPECT_NEAR(section.drivable[0].left_m, 4.0F, 1e-4F);
}

// Without a map nothing is known: no strips, no junctions.
TEST(Drivable, NoMapNoRoad) {
  const auto area = std::make_unique<DrivableArea>();
  build_drivable(nullptr, *area);
  EXPECT_TRUE(area->strips.empty());
  EXPECT_TRUE(area->junctions.empty());
}

}  // namespace s4tp::sadrf
