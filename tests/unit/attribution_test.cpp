#include "sim_host/world/attribution.hpp"

#include <gtest/gtest.h>

namespace s4tp::world {
namespace {

/// Lanes 0 (right) and 1 (left) eastwards along y = 0 and 3.2, 100 m, ending in a junction; there lane 2 goes
/// on straight and is crossed by lane 3 from the south.
Network crossing(Rule rule_of_straight) {
  const auto lane = [](std::vector<Vec2> points, bool in_junction) {
    NetworkLane result;
    result.centre = Polyline(points);
    result.in_junction = in_junction;
    return result;
  };
  Network network;
  network.lanes = {lane({{0.0, 0.0}, {100.0, 0.0}}, false), lane({{0.0, 3.2}, {100.0, 3.2}}, false),
                   lane({{100.0, 0.0}, {120.0, 0.0}}, true), lane({{110.0, -10.0}, {110.0, 10.0}}, true)};
  network.lanes[0].left = 1;
  network.lanes[1].right = 0;
  network.lanes[0].successors = {2};
  network.conflicts = {{2, 3, rule_of_straight, 6.0, 14.0, 6.0, 14.0}};
  return network;
}

CarState car(int id, double x, double y, double speed, LaneId lane, double heading = 0.0) {
  CarState state;
  state.id = id;
  state.centre = {x, y};
  state.speed_mps = speed;
  state.lane = lane;
  state.heading_rad = heading;
  return state;
}

Snapshot at(double time_s, const CarState& ego, const std::vector<CarState>& others) {
  Snapshot snapshot;
  snapshot.time_s = time_s;
  snapshot.ego = ego;
  snapshot.others = others;
  return snapshot;
}

Verdict judge(const Network& network, const std::vector<Snapshot>& history) {
  return attribute(network, history, 7);
}

/// The ego straight on in the junction, the other one crossing from the south.
std::vector<Snapshot> met_in_junction() {
  return {at(0.0, car(0, 103.0, 0.0, 8.0, 2), {car(7, 110.0, -12.0, 8.0, -1, 1.57)}),
          at(1.0, car(0, 108.0, 0.0, 8.0, 2), {car(7, 110.0, -3.0, 8.0, 3, 1.57)})};
}

// WORLD-040 Straight on must yield and did not.
TEST(Attribution, EnteringWithoutPriorityIsOurs) {
  const Verdict verdict = judge(crossing(Rule::kFirstYields), met_in_junction());
  EXPECT_EQ(verdict.fault, Fault::kEgo);
  EXPECT_EQ(verdict.cause, "entered without priority");
}

// WORLD-041 The same with priority on our side.
TEST(Attribution, NotYieldingToUsIsHis) {
  EXPECT_EQ(judge(crossing(Rule::kFirstHasPriority), met_in_junction()).fault, Fault::kOther);
}

// WORLD-042 First come: we were on our lane through the junction 1 s before he was on his.
TEST(Attribution, FirstComeGoesToTheEarlierOne) {
  EXPECT_EQ(judge(crossing(Rule::kFirstCome), met_in_junction()).fault, Fault::kOther);
  std::vector<Snapshot> we_later = met_in_junction();
  we_later[0].ego.lane = 0;
  we_later[0].others[0].lane = 3;
  we_later[1].ego.lane = 2;
  EXPECT_EQ(judge(crossing(Rule::kFirstCome), we_later).fault, Fault::kEgo);
}

// WORLD-043 Out of the right lane into the left one 1 s before he, coming from behind there, touches our
// tail.
TEST(Attribution, CuttingInIsOurs) {
  const Verdict verdict =
      judge(crossing(Rule::kFirstCome), {at(0.0, car(0, 40.0, 1.0, 8.0, 0), {car(7, 30.0, 3.2, 14.0, 1)}),
                                         at(1.0, car(0, 48.0, 2.8, 8.0, 1), {car(7, 43.1, 3.2, 12.0, 1)})});
  EXPECT_EQ(verdict.fault, Fault::kEgo);
  EXPECT_EQ(verdict.cause, "cut in");
}

// WORLD-044 Standing for 2 s in the middle of a free road, 50 m from the junction: ours, though he runs into
// us.
TEST(Attribution, StoppingWithoutReasonIsOurs) {
  const Verdict verdict =
      judge(crossing(Rule::kFirstCome), {at(0.0, car(0, 50.0, 0.0, 0.0, 0), {car(7, 20.0, 0.0, 13.0, 0)}),
                                         at(2.0, car(0, 50.0, 0.0, 0.0, 0), {car(7, 45.1, 0.0, 8.0, 0)})});
  EXPECT_EQ(verdict.fault, Fault::kEgo);
  EXPECT_EQ(verdict.cause, "stopped in a live lane");
}

// WORLD-045 The same before the junction, behind a queue, or rolling: his.
TEST(Attribution, RunningIntoUsFromBehindIsHis) {
  const Network network = crossing(Rule::kFirstCome);
  EXPECT_EQ(judge(network, {at(0.0, car(0, 97.0, 0.0, 0.0, 0), {car(7, 70.0, 0.0, 13.0, 0)}),
                            at(2.0, car(0, 97.0, 0.0, 0.0, 0), {car(7, 92.1, 0.0, 8.0, 0)})})
                .cause,
            "rear-ended by");
  const CarState queue = car(8, 58.0, 0.0, 0.0, 0);
  EXPECT_EQ(judge(network, {at(0.0, car(0, 50.0, 0.0, 0.0, 0), {queue, car(7, 20.0, 0.0, 13.0, 0)}),
                            at(2.0, car(0, 50.0, 0.0, 0.0, 0), {queue, car(7, 45.1, 0.0, 8.0, 0)})})
                .fault,
            Fault::kOther);
  EXPECT_EQ(judge(network, {at(0.0, car(0, 50.0, 0.0, 5.0, 0), {car(7, 45.1, 0.0, 8.0, 0)})}).fault,
            Fault::kOther);
}

// WORLD-046 He changed into our lane a second ago and we touch his tail.
TEST(Attribution, BeingCutInIsHis) {
  const Verdict verdict =
      judge(crossing(Rule::kFirstCome), {at(0.0, car(0, 30.0, 0.0, 12.0, 0), {car(7, 38.0, 2.2, 8.0, 1)}),
                                         at(1.0, car(0, 42.0, 0.0, 12.0, 0), {car(7, 46.9, 0.6, 8.0, 0)})});
  EXPECT_EQ(verdict.fault, Fault::kOther);
  EXPECT_EQ(verdict.cause, "cut in by");
}

// WORLD-047 He just drove ahead of us.
TEST(Attribution, RunningIntoHimIsOurs) {
  EXPECT_EQ(
      judge(crossing(Rule::kFirstCome), {at(0.0, car(0, 30.0, 0.0, 12.0, 0), {car(7, 38.0, 0.0, 8.0, 0)}),
                                         at(1.0, car(0, 42.0, 0.0, 12.0, 0), {car(7, 46.9, 0.0, 8.0, 0)})})
          .cause,
      "ran into");
}

// WORLD-048 Side by side; his box hangs over the line (1.7 - 0.9 = 0.8 m beyond it), ours keeps its lane.
TEST(Attribution, HisComingOverTheLineIsHis) {
  const Verdict verdict =
      judge(crossing(Rule::kFirstCome), {at(0.0, car(0, 40.0, 0.0, 10.0, 0), {car(7, 41.0, 1.75, 10.0, 1)})});
  EXPECT_EQ(verdict.fault, Fault::kOther);
  EXPECT_EQ(verdict.cause, "changed lane into us");
}

// WORLD-049 The same the other way round; and if both left their lanes it counts as ours.
TEST(Attribution, OurComingOverTheLineIsOurs) {
  const Network network = crossing(Rule::kFirstCome);
  EXPECT_EQ(judge(network, {at(0.0, car(0, 40.0, 1.45, 10.0, 0), {car(7, 41.0, 3.2, 10.0, 1)})}).cause,
            "changed lane into");
  EXPECT_EQ(judge(network, {at(0.0, car(0, 40.0, 1.0, 10.0, 0), {car(7, 41.0, 2.7, 10.0, 1)})}).fault,
            Fault::kEgo);
}

}  // namespace
}  // namespace s4tp::world
