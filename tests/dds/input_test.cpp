// Objects and map over DDS: the frames that come of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "firmware/can/frames.hpp"
#include "sim_host/campaign/driver.hpp"
#include "sim_host/campaign/trace.hpp"
#include "sim_host/processes/input_link.hpp"
#include "sim_host/recording/ticks.hpp"
#include "sim_host/telemetry/dds_input.hpp"
#include "sim_host/telemetry/dds_messages.hpp"
#include "sim_host/world/scenario/scenario.hpp"
#include "sim_host/world/world.hpp"
#include "tests/dds/input_publisher.hpp"
#include "tests/support/fake_bus.hpp"

namespace s4tp::telemetry {
namespace {

using tests::message_of;
using tests::Publisher;
using tests::wait_for;

bool same(const std::vector<wire::Frame>& a, const std::vector<wire::Frame>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), recording::same);
}

// TELE-040 What a node on the bus sends of lists and maps, and what comes of the same over DDS: the same frames,
// tick by tick, and two ECUs that get the one and the other answer the same to the bit, driving.
TEST(DdsInput, TheSameOverDdsIsTheSameOnTheBus) {
  const scenario::Scenario scenario =
      scenario::load_scenario(std::filesystem::path(S4TP_SOURCE_DIR) / "sim_host/scenarios/left_turn");
  world::WorldOptions options;
  options.seed = 3;
  world::World world(scenario, options);
  campaign::Trace trace;
  const auto by_frames = campaign::make_driver("s4tp", true, Parameters{}, &trace, &trace);
  const auto by_dds = campaign::make_driver("s4tp", true, Parameters{}, nullptr, nullptr);
  Publisher publisher;
  std::ostringstream complaints;
  const auto input = std::make_unique<DdsInput>(publisher.participant(), complaints);
  ASSERT_TRUE(wait_for([&] { return publisher.heard(); }));

  const auto tracks_seen = std::make_unique<wire::TrackListReceiver>();
  const auto map_seen = std::make_unique<wire::MapReceiver>();
  wire::TrackListSender track_sender;
  const auto map_sender = std::make_unique<wire::MapSender>();
  bool map_known = false;
  std::uint64_t lists = 0;
  std::uint64_t maps = 0;
  std::size_t input_frames = 0;
  std::size_t most_tracks = 0;
  int driven = 0;
  for (std::uint32_t now_ms = 10; now_ms <= 15'000 && !world.finished(); now_ms += 10) {
    std::vector<wire::Frame> told;
    world.tick(told);
    bool new_list = false;
    std::vector<wire::Frame> others;
    for (const wire::Frame& frame : told) {
      if (!processes::InputLink::is_input(frame.id)) others.push_back(frame);
      new_list = tracks_seen->accept(frame) || new_list;
      map_known = map_seen->accept(frame) || map_known;
    }
    Arena arena;
    if (new_list) {
      wire::Tracks list = tracks_seen->tracks();
      list.left_out = 0;  // the message has no such field
      most_tracks = std::max<std::size_t>(most_tracks, list.count);
      track_sender.start(list);
      publisher.tell(message_of(list, arena));
      ++lists;
    }
    if (map_known && now_ms % 100 == 0) {
      map_sender->update(map_seen->map());
      publisher.tell(message_of(map_seen->map(), arena));
      ++maps;
    }
    ASSERT_TRUE(wait_for([&] {
      input->look(now_ms);
      const InputReport& report = input->report();
      return report.objects.taken() + report.objects.refused() == lists &&
             report.maps.taken() + report.maps.refused() == maps;
    })) << "at "
        << now_ms;
    hal::linux_host::FakeBus link;
    input->send(now_ms, link);
    std::vector<wire::Frame> from_dds;
    for (const hal::CanFrame& frame : link.sent) from_dds.push_back(to_wire(frame));
    std::vector<wire::Frame> from_node;
    wire::Frame frame;
    for (int i = 0; i < 12 && track_sender.next(frame); ++i) from_node.push_back(frame);
    for (int i = 0; i < 7 && map_known && map_sender->next(now_ms, frame); ++i) from_node.push_back(frame);
    ASSERT_TRUE(same(from_node, from_dds)) << "at " << now_ms;
    input_frames += from_dds.size();

    // TICK last.
    from_node.insert(from_node.end(), others.begin(), others.end());
    from_dds.insert(from_dds.end(), others.begin(), others.end());
    std::vector<wire::Frame> answers;
    std::vector<wire::Frame> answers_by_dds;
    by_frames->tick(from_node, answers);
    by_dds->tick(from_dds, answers_by_dds);
    ASSERT_TRUE(same(answers, answers_by_dds)) << "at " << now_ms;
    for (const wire::Frame& answer : answers) world.receive(answer);
    driven += by_dds->core().mode() == ecu::Mode::kDriving ? 1 : 0;
  }
  EXPECT_EQ(input->report().objects.refused() + input->report().maps.refused(), 0U) << complaints.str();
  EXPECT_GT(lists, 100U);
  EXPECT_GT(maps, 100U);
  EXPECT_GT(most_tracks, 1U);
  EXPECT_GT(input_frames, 1000U);
  EXPECT_GT(driven, 500) << "of the ticks";
}

// TELE-041 An object keeps its id while it is known; two whose uuids end alike get different ones.
TEST(DdsInput, IdsAreKeptAndNotShared) {
  TrackIds ids;
  TrackIds::Uuid one{};
  one[15] = 7;
  TrackIds::Uuid other = one;
  other[0] = 1;
  ids.next_list();
  EXPECT_EQ(ids.id_of(one), 7);
  const std::uint8_t given = ids.id_of(other);
  EXPECT_NE(given, 7);
  ids.next_list();
  EXPECT_EQ(ids.id_of(other), given);
  EXPECT_EQ(ids.id_of(one), 7);
}

// TELE-043 10 a second pass. Of 1000 in a second the first passes; and when 10 a second follow, none for the
// second after the last full one, then all.
TEST(DdsInput, AFloodEndsAfterAQuietSecond) {
  RateGuard guard;
  for (std::uint32_t now_ms = 0; now_ms < 3000; now_ms += 100) EXPECT_TRUE(guard.admits(now_ms)) << now_ms;
  RateGuard flooded;
  int passed = 0;
  for (std::uint32_t now_ms = 0; now_ms < 1000; ++now_ms) passed += flooded.admits(now_ms) ? 1 : 0;
  EXPECT_EQ(passed, 1);
  for (std::uint32_t now_ms = 1000; now_ms < 2000; now_ms += 100) EXPECT_FALSE(flooded.admits(now_ms));
  for (std::uint32_t now_ms = 2000; now_ms < 3000; now_ms += 100) EXPECT_TRUE(flooded.admits(now_ms));
}

// TELE-045 Once told, a map is sent for 2 s and no longer: 2.01 s later no frame comes of it.
TEST(DdsInput, AMapNotToldAgainIsNotSent) {
  Publisher publisher;
  std::ostringstream complaints;
  const auto input = std::make_unique<DdsInput>(publisher.participant(), complaints);
  ASSERT_TRUE(wait_for([&] { return publisher.heard(); }));
  Arena arena;
  const auto map = std::make_unique<wire::Map>();
  publisher.tell(message_of(*map, arena));
  ASSERT_TRUE(wait_for([&] {
    input->look(1000);
    return input->report().maps.taken() == 1;
  }));
  hal::linux_host::FakeBus link;
  input->send(3000, link);
  EXPECT_FALSE(link.sent.empty());
  link.sent.clear();
  input->send(3010, link);
  EXPECT_TRUE(link.sent.empty());
}

}  // namespace
}  // namespace s4tp::telemetry
