// What the ECU's reports say of a plan.

#include "firmware/ecu/reports.hpp"

#include <gtest/gtest.h>

#include "firmware/can/frames.hpp"
#include "firmware/wire/codec.hpp"
#include "tests/support/fake_bus.hpp"

namespace s4tp::ecu {
namespace {

wire::PlanReason sent(const planner::Explanation& explanation) {
  hal::linux_host::FakeBus bus;
  Reporter reporter;
  reporter.plan(bus, 1, 2, explanation);
  wire::PlanReason reason;
  EXPECT_TRUE(wire::decode(to_wire(bus.sent.back()), reason));
  return reason;
}

// ECU-101 Four vehicles and 200 lanes were left out, of which 31 can be said, and two bear one id; what blocks us is one of
// those left out, then it is vehicle 7, then nobody.
TEST(Reports, SayWhomThePlanWasNotToldOf) {
  planner::Explanation explanation;
  explanation.tracks_left_out = 4;
  explanation.lanes_left_out = 200;
  explanation.id_clashes = 2;
  explanation.blocking.verdict.cause = safety::Cause::kZone;
  explanation.blocking.verdict.agent = safety::kUnseen;
  EXPECT_EQ(sent(explanation).tracks_left_out, 4);
  EXPECT_EQ(sent(explanation).lanes_left_out, 31);
  EXPECT_EQ(sent(explanation).id_clashes, 2);
  EXPECT_EQ(sent(explanation).unseen, 1);
  explanation.blocking.verdict.agent = 3;
  explanation.blocking.track = 7;
  EXPECT_EQ(sent(explanation).unseen, 0);
  EXPECT_EQ(sent(planner::Explanation{}).unseen, 0);
  EXPECT_EQ(sent(planner::Explanation{}).tracks_left_out, 0);
}

}  // namespace
}  // namespace s4tp::ecu
