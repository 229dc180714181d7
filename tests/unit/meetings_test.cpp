#include "sim_host/train/meetings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/support/networks.hpp"

namespace s4tp::train {
namespace {

using test::kCross;

/// On the cross: we come from the west and yield, the other one from the south; zones lie around the origin.
class AtTheCross : public testing::Test {
 protected:
  /// A drive of 8 s; positions along each road are functions of time, 0 at the crossing point.
  template <class Ego, class Car>
  Meeting drive(Ego ego_m, Car car_m) const {
    std::vector<traffic::Snapshot> snapshots;
    for (int i = 0; i <= 80; ++i) {
      traffic::Snapshot snapshot;
      snapshot.time_s = 0.1 * i;
      snapshot.ego.centre = {ego_m(snapshot.time_s), 0.0};
      snapshot.ego.lane = lane("west_in_0", ":c_0_0", "east_out_0", snapshot.ego.centre.x);
      traffic::CarState car;
      car.id = 7;
      car.centre = {0.0, car_m(snapshot.time_s)};
      car.lane = lane("south_in_0", ":c_1_0", "north_out_0", car.centre.y);
      snapshot.others.push_back(car);
      snapshots.push_back(snapshot);
    }
    return Meetings(network_, guide_, snapshots).with(7);
  }

  map::LaneId lane(const char* in, const char* across, const char* out, double along_m) const {
    return network_.find(along_m < -10.0 ? in : along_m < 10.0 ? across : out);
  }

  map::Network network_ = test::network_of(kCross);
  map::RouteGuide guide_{network_, {"west_in", "east_out"}, network_.find("east_out_0"), 40.0};
};

auto at(double start_m, double speed_mps) {
  return [=](double time_s) { return start_m + speed_mps * time_s; };
}

// TRAIN-010 Who has left the crossing before the other one comes was first; it has priority there.
TEST_F(AtTheCross, FirstIsWhoHasGone) {
  const Meeting after = drive(at(-40.0, 6.0), at(-20.0, 10.0));  // it is there at 2 s, we are at 6.7 s
  EXPECT_EQ(after.yields, 0);
  EXPECT_EQ(after.rule, SampleRule::kHasPriority);
  EXPECT_TRUE(after.shares);
  const Meeting before = drive(at(-20.0, 10.0), at(-45.0, 7.0));
  EXPECT_EQ(before.yields, 1);
  EXPECT_GT(before.entry_s, 0.5);
  EXPECT_LT(before.entry_s, 2.0);
}

// TRAIN-010 It stands before its line and we have crossed: it let us go. We stand and it has not come: open.
TEST_F(AtTheCross, WhoNeverComesHasYielded) {
  EXPECT_EQ(drive(at(-20.0, 8.0), at(-16.0, 0.0)).yields, 1);
  EXPECT_EQ(drive(at(-16.0, 0.0), at(-45.0, 2.0)).yields, -1);
}

// What has been passed already is nobody's meeting.
TEST_F(AtTheCross, ThePastDoesNotCount) {
  const Meeting gone = drive(at(20.0, 1.0), at(-45.0, 8.0));
  EXPECT_EQ(gone.rule, SampleRule::kNoZone);
  EXPECT_EQ(gone.yields, -1);
  EXPECT_FALSE(gone.shares);
}

}  // namespace
}  // namespace s4tp::train
