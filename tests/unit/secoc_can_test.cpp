// The bus decorator of firmware/secoc: what reaches an application is what the other end has sent, or nothing.
#include "tests/support/secoc_can.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <vector>

#include "sim_host/processes/authentic_link.hpp"

namespace s4tp::secoc {
namespace {

bool equal(const Frames& a, const Frames& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), same);
}

// AUTH-001, AUTH-006 A group comes out as it went in, before the TICK behind it; without its companion it
// does not come out at all.
TEST_F(SecocCan, AGroupComesWithItsCompanion) {
  const Frames motion = rig.motion_group();
  const Frames bus = on_the_bus(motion);
  ASSERT_EQ(bus.size(), motion.size() + 2) << "companion and TICK";
  EXPECT_EQ(bus[bus.size() - 2].id, wire::kMotionAuthId);
  const Frames got = reaches_ecu(bus);
  ASSERT_EQ(got.size(), motion.size() + 1);
  EXPECT_TRUE(equal(protected_ones(got), motion));
  EXPECT_EQ(got.back().id, wire::kTickId);

  Frames bare = on_the_bus(rig.motion_group());
  std::erase_if(bare, [](const wire::Frame& frame) { return frame.id == wire::kMotionAuthId; });
  EXPECT_TRUE(protected_ones(reaches_ecu(bare)).empty());
}

// AUTH-005 Truncated: with any one frame of the group missing nothing of it comes out. AUTH-003 Any one bit
// of any frame changed, its CRC made to fit: the same.
TEST_F(SecocCan, NothingOfATruncatedOrChangedGroup) {
  (void)rig.motion_group();
  rig.number += rig.number % 2;  // with a pose
  const std::size_t frames = on_the_bus(rig.motion_group()).size() - 1;
  ASSERT_EQ(frames, 4U);
  for (std::size_t missing = 0; missing < frames; ++missing) {
    Frames bus = on_the_bus(rig.motion_group());
    bus.erase(bus.begin() + static_cast<std::ptrdiff_t>(missing));
    EXPECT_TRUE(protected_ones(reaches_ecu(bus)).empty()) << missing;
  }
  int tried = 0;
  for (std::size_t which = 0; which < frames; ++which) {
    const Frames bus = on_the_bus(rig.motion_group());
    for (unsigned bit = 8; bit < 64; ++bit) {
      Frames changed = bus;
      changed[which].data[bit / 8U] =
          static_cast<std::uint8_t>(changed[which].data[bit / 8U] ^ 1U << bit % 8U);
      if (which + 1 < frames) wire::e2e_seal(changed[which]);
      EXPECT_TRUE(protected_ones(reaches_ecu(changed)).empty()) << which << " bit " << bit;
      ++tried;
    }
    EXPECT_FALSE(protected_ones(reaches_ecu(on_the_bus(rig.motion_group()))).empty()) << "the next one does";
  }
  EXPECT_EQ(tried, 4 * 56);
}

// AUTH-005 A group put together from two, each genuine, with either companion: nothing comes out.
TEST_F(SecocCan, NothingOfAMixture) {
  const Frames one = on_the_bus(rig.motion_group());
  const Frames two = on_the_bus(rig.motion_group());
  Frames mixed = two;
  mixed[1] = one[1];
  EXPECT_FALSE(same(one[1], two[1]));
  EXPECT_TRUE(protected_ones(reaches_ecu(mixed)).empty());
  mixed[mixed.size() - 2] = one[one.size() - 2];
  EXPECT_TRUE(protected_ones(reaches_ecu(mixed)).empty());
}

// AUTH-004, AUTH-005 Recorded groups said again, one by one, all at once, in reverse: none comes out a second
// time; one that was held back until a later one had come does not come out either.
TEST_F(SecocCan, NothingReplayed) {
  std::vector<Frames> recorded;
  for (int i = 0; i < 20; ++i) {
    recorded.push_back(on_the_bus(rig.motion_group()));
    if (i == 10) continue;  // held back
    EXPECT_FALSE(protected_ones(reaches_ecu(recorded.back())).empty());
  }
  for (const Frames& frames : recorded) EXPECT_TRUE(protected_ones(reaches_ecu(frames)).empty());
  std::reverse(recorded.begin(), recorded.end());
  for (const Frames& frames : recorded) EXPECT_TRUE(protected_ones(reaches_ecu(frames)).empty());
}

// AUTH-001 Commands: forged ones in the ECU's name do not reach the vehicle, with or without a companion of
// the forger's; damaged companions and frames of another length neither.
TEST_F(SecocCan, NoForgedCommand) {
  rig.to_world.clear();
  wire::E2eSender forger;
  for (int i = 0; i < 100; ++i) {
    wire::Command command;
    command.acceleration_mps2 = 3.0F;
    rig.inject(SecocRig::protect(command, forger));
    if (i % 2 == 0) rig.inject(wire::Frame{wire::kCommandAuthId, 8, {1, 2, 3, 4, 5, 6, 7, 8}});
    if (i % 3 == 0) rig.inject(wire::Frame{wire::kCommandId, 7, {1, 2, 3}});
    for (const wire::Frame& frame : rig.world.take()) rig.to_world.push_back(frame);
  }
  EXPECT_EQ(count(rig.to_world, wire::kCommandId), 0);
  EXPECT_GE(rig.world.can->tally().refused, 50U);
  EXPECT_EQ(rig.world.can->counters().errors, rig.world.can->tally().refused);
  EXPECT_TRUE(rig.tick().command) << "the genuine one still does";
}

// AUTH-001 What one end says is not taken by itself: its own messages in a stranger's mouth, and the other
// end's companions turned round.
TEST_F(SecocCan, NothingOfOnesOwn) {
  wire::E2eSender forger;
  rig.inject(SecocRig::protect(wire::Command{}, forger));
  for (const wire::Frame& frame : rig.seen(wire::kCommandId)) rig.inject(frame);
  EXPECT_TRUE(rig.ecu.take().empty());
}

// AUTH-008 A forged motion group that waits for its companion when the ECU says its command gets none from the
// ECU, so that nothing the ECU has said makes it genuine when it is said back; of the world's end and a
// forged command the same. (Found by the fuzz target secoc.)
TEST_F(SecocCan, AnEndDoesNotSealWhatItHears) {
  wire::E2eSender forger;
  for (int i = 0; i < 20; ++i) {
    const wire::Frame motion = SecocRig::protect(wire::Motion{}, forger);
    const wire::Frame command = SecocRig::protect(wire::Command{}, forger);
    rig.inject(motion);
    rig.inject(command);
    (void)rig.ecu.take();
    (void)rig.world.take();
    rig.wire.seen.clear();
    SecocRig::put(rig.ecu, wire::Command{}, rig.command_sender);
    const Frames of_ecu = rig.wire.seen;
    EXPECT_EQ(count(of_ecu, wire::kMotionAuthId), 0);
    rig.wire.seen.clear();
    put_tick();
    const Frames of_world = rig.wire.seen;
    EXPECT_EQ(count(of_world, wire::kCommandAuthId), 0);
    Frames said_back = {motion, command};
    said_back.insert(said_back.end(), of_ecu.begin(), of_ecu.end());
    EXPECT_TRUE(protected_ones(reaches_ecu(said_back)).empty());
  }
}

// AUTH-001 All other messages pass as they are.
TEST_F(SecocCan, OthersPass) {
  for (const wire::MessageInfo& message : wire::kMessages) {
    const bool others = message.id == wire::kTickId || message.id == wire::kVersionWorldId ||
                        message.id == wire::kMapOriginId || message.id == wire::kEcuStatusId;
    if (!others) continue;
    EXPECT_EQ(reaches_ecu({wire::Frame{message.id, 8, {1, 2, 3}}}).size(), 1U) << message.name;
  }
}

// AUTH-032 What is told of a session: its beginning and its end once, and the sums.
TEST_F(SecocCan, SessionsAreTold) {
  processes::SessionTeller teller("ECU");
  std::ostringstream told;
  for (int i = 0; i < 3; ++i) teller.tell(told, *rig.ecu.can);
  EXPECT_EQ(told.str(), "ECU: authentic session 1\n");
  rig.wire.lost = [](const wire::Frame&) { return true; };
  for (int i = 0; i < 110; ++i) {
    (void)rig.tick();
    teller.tell(told, *rig.ecu.can);
  }
  EXPECT_NE(told.str().find("the authentic session is over"), std::string::npos);
  rig.inject(wire::Frame{wire::kMotionAuthId, 8, {1}});
  (void)rig.ecu.take();
  told.str("");
  teller.sum_up(told, *rig.ecu.can);
  EXPECT_NE(told.str().find("1 authentic sessions"), std::string::npos);
  EXPECT_NE(told.str().find(", 1 refused"), std::string::npos);
}

}  // namespace
}  // namespace s4tp::secoc
