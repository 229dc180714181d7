// What the planner makes of lists that have no room for everybody.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "algo/planner/planner.hpp"
#include "tests/support/lane_maps.hpp"

namespace s4tp::planner {
namespace {

using test::car;

/// Drives at its own planned state among cars that keep their speed; lists carry the nearest sixteen.
class Crowd {
 public:
  Crowd(const LaneMap& map, Pose rear_axle, float speed_mps, std::vector<Track> others)
      : cars(std::move(others)), map_(std::make_unique<LaneMap>(map)) {
    EXPECT_EQ(planner_->init(Parameters{}), Status::kOk);
    input_.start_ms = 100;
    input_.ego.rear_axle = rear_axle;
    input_.ego.speed_mps = speed_mps;
  }

  Status step() {
    list();
    input_.map = map_.get();
    input_.running = &running_;
    Plan next;
    const Status status = planner_->plan(input_, next, explanation);
    running_ = next;
    input_.now_ms += 100;
    input_.start_ms += 100;
    input_.tracks_ms = input_.now_ms;
    const TrajectoryPoint now = sample(running_, input_.now_ms);
    input_.ego = {now.rear_axle, now.speed_mps, now.acceleration_mps2, now.speed_mps * now.curvature_1pm,
                  std::atan(2.9F * now.curvature_1pm)};
    for (Track& one : cars) one.centre = shift_ahead(one.centre, 0.1F * one.speed_mps);
    return status;
  }

  /// A cycle may take as much work as it likes.
  void has_all_the_time() { planner_->allowance.cycle = 100'000'000; }

  [[nodiscard]] const EgoState& ego() const { return input_.ego; }
  std::vector<Track> cars;
  bool tells = true;  ///< that some are left out
  Explanation explanation;

 private:
  void list() {
    const Point centre = offset_point(input_.ego.rear_axle, 1.5F, 0.0F);
    std::vector<Track> nearest = cars;
    std::stable_sort(nearest.begin(), nearest.end(), [&](const Track& a, const Track& b) {
      return distance(position(a.centre), centre) < distance(position(b.centre), centre);
    });
    input_.tracks.clear();
    input_.tracks.left_out = 0;
    for (const Track& one : nearest) {
      if (!input_.tracks.push(one) && tells) ++input_.tracks.left_out;
    }
  }

  std::unique_ptr<Planner> planner_ = std::make_unique<Planner>();
  std::unique_ptr<LaneMap> map_;
  PlannerInput input_;
  Plan running_;
};

/// Twenty that are parked beside the road behind us, 15 to 44 m away.
std::vector<Track> car_park() {
  std::vector<Track> cars;
  for (int i = 0; i < 20; ++i)
    cars.push_back(car(i + 1, -45.0F + 5.0F * static_cast<float>(i % 5),
                       -30.0F + 6.0F * static_cast<float>(i / 5), 1.5708F, 0.0F));
  return cars;
}

// CORE-037 We wait to turn left; twenty cars stand nearer than the one that comes towards us at 13.9 m/s, so that
// the list does not name it. Told that five are left out we let it pass, and the explanation says for whom; told
// nothing we set off.
TEST(LeftOut, WeWaitForWhomTheListHasNoRoomFor) {
  for (const bool tells : {true, false}) {
    test::CrossJunction cross = test::cross_junction(120.0F);
    test::set_route(cross, test::CrossJunction::kEast, test::CrossJunction::kLeft);
    std::vector<Track> cars = car_park();
    cars.push_back(car(77, 70.0F, 1.6F, 3.14159F, 13.9F));
    Crowd crowd(cross.map, {-13.5F, -1.6F, 0.0F}, 0.0F, cars);
    crowd.tells = tells;
    bool named = false;
    for (int i = 0; i < 40; ++i) {
      (void)crowd.step();
      const int known_to_be_left_out = tells ? 5 : 0;  // and those that the scene then lacks room for
      EXPECT_GE(crowd.explanation.tracks_left_out, known_to_be_left_out);
      named = named || crowd.explanation.blocking.unseen();
    }
    EXPECT_EQ(crowd.ego().rear_axle.x_m > -8.0F, !tells);
    EXPECT_EQ(named, tells);
  }
}

// CORE-037 On a straight road two lanes beside ours are full and ours is free: it is driven, at a speed from which
// we can stop on what is known.
TEST(LeftOut, AFreeLaneBesideQueuesIsDriven) {
  std::vector<Track> cars;
  for (int i = 0; i < 40; ++i) {
    const float x_m = 5.0F + 8.0F * static_cast<float>(i / 2);
    cars.push_back(car(i + 1, x_m, test::kLaneWidthM * static_cast<float>(1 + i % 2), 0.0F, 0.0F));
  }
  Crowd crowd(test::straight_road(3, 400.0F), {60.0F, 0.0F, 0.0F}, 0.0F, cars);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(crowd.step(), Status::kOk) << i;
  EXPECT_GT(crowd.ego().rear_axle.x_m, 120.0F);
}

// CORE-037 Behind a queue in our own lane nothing changes, to the bit: whoever leads us is nearer than whoever is left out. Looking
// for whoever may come takes work, which the optimizer then lacks: within the cycle's allowance we stand 1 cm elsewhere at most.
TEST(LeftOut, BehindAQueueWeStandBehindItsLast) {
  for (const bool bounded : {false, true}) {
    float stands_at_m[2] = {};
    for (const bool tells : {true, false}) {
      std::vector<Track> cars;
      for (int i = 0; i < 24; ++i)
        cars.push_back(car(i + 1, 120.0F + 7.0F * static_cast<float>(i), 0.0F, 0.0F, 0.0F));
      Crowd crowd(test::straight_road(1, 400.0F), {50.0F, 0.0F, 0.0F}, 12.0F, cars);
      crowd.tells = tells;
      if (!bounded) crowd.has_all_the_time();
      for (int i = 0; i < 150; ++i) EXPECT_EQ(crowd.step(), Status::kOk) << i;
      EXPECT_LT(crowd.ego().speed_mps, 0.3F);
      stands_at_m[tells ? 1 : 0] = crowd.ego().rear_axle.x_m;
    }
    EXPECT_NEAR(stands_at_m[0], stands_at_m[1], bounded ? 0.01F : 0.0F);
  }
}

}  // namespace
}  // namespace s4tp::planner
