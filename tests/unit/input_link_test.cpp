#include "sim_host/processes/input_link.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "tests/support/fake_bus.hpp"

namespace s4tp::processes {
namespace {

// PROC-045 PROC-046 Of the bus no lists, of the link nothing else; and of a flood on the link no more than a
// share between two motion frames.
TEST(InputLink, EachMessageComesFromOneSide) {
  hal::linux_host::FakeBus bus;
  hal::linux_host::FakeBus link;
  const auto frame = [](std::uint32_t id, std::uint8_t mark) {
    hal::CanFrame made;
    made.id = id;
    made.length = 8;
    made.data[0] = mark;
    return made;
  };
  bus.incoming = {frame(wire::kTrackListId, 1), frame(wire::kMotionId, 1), frame(wire::kMapHeaderId, 1),
                  frame(wire::kTickId, 1)};
  link.incoming = {frame(wire::kMotionId, 2), frame(wire::kTrackListId, 2), frame(wire::kSteeringId, 2),
                   frame(wire::kMapHeaderId, 2)};
  InputLink both(bus, link);
  std::vector<std::pair<std::uint32_t, int>> got;
  for (hal::CanFrame taken; both.receive(taken);) got.emplace_back(taken.id, taken.data[0]);
  const std::vector<std::pair<std::uint32_t, int>> expected = {
      {wire::kTrackListId, 2}, {wire::kMapHeaderId, 2}, {wire::kMotionId, 1}, {wire::kTickId, 1}};
  EXPECT_EQ(got, expected);

  link.incoming = {frame(wire::kTrackListId, 2)};
  link.endless = true;
  bus.incoming = {frame(wire::kMotionId, 1), frame(wire::kTickId, 1)};
  InputLink flooded(bus, link);
  std::vector<std::uint32_t> order;
  for (hal::CanFrame taken; flooded.receive(taken) && order.size() < 200;) order.push_back(taken.id);
  EXPECT_EQ(std::count(order.begin(), order.end(), wire::kMotionId), 1);
  EXPECT_EQ(std::count(order.begin(), order.end(), wire::kTickId), 1);
  EXPECT_LE(order.size(), 2U * InputLink::kShare + 2U);
}

}  // namespace
}  // namespace s4tp::processes
