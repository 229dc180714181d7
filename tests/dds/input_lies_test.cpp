// What liars get through of objects and map over DDS: nothing, and it is told.
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "firmware/can/frames.hpp"
#include "firmware/wire/codec.hpp"
#include "hal/linux/named_bus.hpp"
#include "sim_host/processes/child_process.hpp"
#include "sim_host/telemetry/dds_input.hpp"
#include "sim_host/telemetry/dds_messages.hpp"
#include "tests/dds/input_publisher.hpp"
#include "tests/support/fake_bus.hpp"
#include "tests/support/free_port.hpp"

namespace s4tp::telemetry {
namespace {

using tests::message_of;
using tests::Publisher;
using tests::wait_for;

/// What the telemetry process says of its input on the diagnostics topic.
class Diagnostics {
 public:
  explicit Diagnostics(dds_entity_t participant) {
    const dds_entity_t topic = dds_create_topic(participant, &diagnostic_msgs_msg_dds__DiagnosticArray__desc,
                                                "rt/diagnostics", nullptr, nullptr);
    dds_qos_t* const qos = dds_create_qos();
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
    reader_ = dds_create_reader(participant, topic, qos, nullptr);
    dds_delete_qos(qos);
  }
  /// \return the newest value of a key; -1: not told
  double value(const std::string& key) {
    for (;;) {
      void* samples[1] = {};
      dds_sample_info_t info;
      if (dds_take(reader_, samples, &info, 1, 1) <= 0) break;
      const auto& array = *static_cast<const DiagnosticArray*>(samples[0]);
      for (std::uint32_t i = 0; info.valid_data && i < array.status._length; ++i) {
        const auto& status = array.status._buffer[i];
        if (std::string(status.name) != "s4tp: input over DDS") continue;
        for (std::uint32_t k = 0; k < status.values._length; ++k)
          values_[status.values._buffer[k].key] = std::stod(status.values._buffer[k].value);
      }
      (void)dds_return_loan(reader_, samples, 1);
    }
    const auto found = values_.find(key);
    return found == values_.end() ? -1.0 : found->second;
  }

 private:
  dds_entity_t reader_ = 0;
  std::map<std::string, double> values_;
};

/// A list of two objects that nothing is wrong with.
wire::Tracks good_list() {
  wire::Tracks good;
  good.count = 2;
  for (int i = 0; i < 2; ++i) {
    good.items[i] = {
        static_cast<std::uint8_t>(1 + i), 10.0F + 5.0F * i, 2.0F, 0.1F, 8.0F, 0.5F, 0.05F, 4.5F, 1.8F};
  }
  return good;
}

// TELE-041..044 A publisher that lies: not a frame comes of wrong numbers and sizes, each is counted under its
// reason; of 1000 lists in a second none passes but the first; after a quiet second a good list comes through, whole.
// The input's clock is the test's: how busy the machine is changes nothing.
TEST(DdsInput, LiesDoNotReachTheEcu) {
  Publisher publisher;
  std::ostringstream complaints;
  const auto input = std::make_unique<DdsInput>(publisher.participant(), complaints);
  ASSERT_TRUE(wait_for([&] { return publisher.heard(); }));
  hal::linux_host::FakeBus link;
  std::uint32_t now_ms = 1000;
  std::uint64_t told = 0;
  const auto& objects = input->report().objects;
  const auto& maps = input->report().maps;
  const auto tell = [&](const auto& message, std::uint32_t later_ms) {
    now_ms += later_ms;
    publisher.tell(message);
    ++told;
    ASSERT_TRUE(wait_for([&] {
      input->look(now_ms);
      return objects.taken() + objects.refused() + maps.taken() + maps.refused() == told;
    })) << "message "
        << told;
    input->send(now_ms, link);
  };
  const wire::Tracks good = good_list();
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  using Spoil = std::function<void(TrackedObjects&)>;
  const auto& kinematics = [](TrackedObjects & list) -> auto& {
    return list.objects._buffer[1].kinematics;
  };
  const std::vector<Spoil> no_numbers = {
      [&](auto& list) { kinematics(list).pose_with_covariance.pose.position.x = kNan; },
      [&](auto& list) { kinematics(list).pose_with_covariance.pose.position.y = kInfinite; },
      [&](auto& list) { kinematics(list).pose_with_covariance.pose.orientation.w = kNan; },
      [&](auto& list) { kinematics(list).twist_with_covariance.twist.linear.x = -kInfinite; },
      [&](auto& list) { kinematics(list).twist_with_covariance.twist.angular.z = kNan; },
      [&](auto& list) { kinematics(list).acceleration_with_covariance.accel.linear.x = kNan; },
      [&](auto& list) { list.objects._buffer[1].shape.dimensions.x = kNan; },
  };
  const std::vector<Spoil> absurd = {
      [&](auto& list) { kinematics(list).pose_with_covariance.pose.position.x = 1e300; },
      [&](auto& list) { kinematics(list).pose_with_covariance.pose.position.y = -1311.0; },
      [&](auto& list) {
        kinematics(list).pose_with_covariance.pose.orientation = {0.0, 0.0, 0.0, 0.0};
      },
      [&](auto& list) { kinematics(list).twist_with_covariance.twist.linear.x = 61.0; },
      [&](auto& list) { kinematics(list).twist_with_covariance.twist.linear.x = -5.0; },
      [&](auto& list) { kinematics(list).acceleration_with_covariance.accel.linear.x = 40.0; },
      [&](auto& list) { list.objects._buffer[1].shape.dimensions.x = -4.0; },
      [&](auto& list) { list.objects._buffer[1].shape.dimensions.y = 0.0; },
      [&](auto& list) { list.objects._buffer[1].object_id.uuid[15] = 1; },
  };
  Arena arena;
  const auto tell_all = [&](const std::vector<Spoil>& spoils) {
    for (const Spoil& spoil : spoils) {
      TrackedObjects list = message_of(good, arena);
      spoil(list);
      tell(list, 100);
    }
  };
  tell_all(no_numbers);
  tell_all(absurd);
  const std::vector<Spoil> sizes = {[&](auto& list) { arena.sequence(list.objects, 17); },
                                    [&](auto& list) { arena.sequence(list.objects, 2000); }};
  tell_all(sizes);
  tell_all({[&](auto& list) { list.header.frame_id = arena.text("base_link"); }});
  tell_all({[&](auto& list) { list.header.stamp.nanosec = 2'000'000'000U; }});

  const auto lane_map = std::make_unique<wire::Map>();
  for (int slot = 0; slot < 2; ++slot) {
    wire::Lane& lane = lane_map->lanes[slot];
    lane.present = true;
    lane.point_count = 2;
    lane.width_m = 3.2F;
    lane.speed_limit_mps = 13.75F;
    lane.x_m[1] = 50.0F;
  }
  lane_map->conflicts[0] = {true, 0, 1, 0, 10.0F, 20.0F, 10.0F, 20.0F};
  using SpoilMap = std::function<void(LaneMapMessage&)>;
  const std::vector<SpoilMap> map_lies = {
      [&](auto& map) { arena.sequence(map.lanes, 65); },
      [&](auto& map) { arena.sequence(map.conflicts, 129); },
      [&](auto& map) { arena.sequence(map.lanes._buffer[0].points, 13); },
      [&](auto& map) { map.lanes._buffer[0].points._buffer[1].x = static_cast<float>(kNan); },
      [&](auto& map) { map.lanes._buffer[0].speed_limit_mps = static_cast<float>(kInfinite); },
      [&](auto& map) { map.lanes._buffer[1].width_m = 100.0F; },
      [&](auto& map) { map.lanes._buffer[1].slot = 64; },
      [&](auto& map) { map.lanes._buffer[1].slot = 0; },
      [&](auto& map) { map.conflicts._buffer[0].first_exit_m = 5.0F; },
      [&](auto& map) { map.conflicts._buffer[0].second = 3; },
  };
  for (const SpoilMap& spoil : map_lies) {
    LaneMapMessage map = message_of(*lane_map, arena);
    spoil(map);
    tell(map, 100);
  }
  EXPECT_TRUE(link.sent.empty()) << link.sent.size() << " frames of lies";
  const auto counted = [](const InputCounts& counts, Refusal refusal) {
    return counts.by[static_cast<int>(refusal)];
  };
  EXPECT_EQ(counted(objects, Refusal::kNotANumber), no_numbers.size());
  EXPECT_EQ(counted(objects, Refusal::kOutOfRange), absurd.size());
  EXPECT_EQ(counted(objects, Refusal::kTooMany), sizes.size());
  EXPECT_EQ(counted(objects, Refusal::kFrame), 1U);
  EXPECT_EQ(counted(objects, Refusal::kStamp), 1U);
  EXPECT_EQ(counted(maps, Refusal::kTooMany), 3U);
  EXPECT_EQ(counted(maps, Refusal::kNotANumber), 2U);
  EXPECT_EQ(counted(maps, Refusal::kOutOfRange), 5U);
  EXPECT_EQ(objects.taken() + maps.taken(), 0U);

  now_ms += 2000;
  for (int i = 0; i < 1000; ++i) tell(message_of(good, arena), 1);
  EXPECT_EQ(objects.taken(), 1U);
  EXPECT_EQ(counted(objects, Refusal::kTooOften), 999U);
  EXPECT_EQ(link.sent.size(), 5U) << "one list of two objects";

  link.sent.clear();
  tell(message_of(good, arena), 2000);
  ASSERT_EQ(link.sent.size(), 5U);
  EXPECT_EQ(link.sent[0].id, wire::kTrackListId);
}

// TELE-041..044 The process as it runs passes a good list on, whole, and of two lies nothing; it tells all three on
// the diagnostics topic. Each is told when the one before has been counted, and long enough after it.
TEST(DdsInput, TheProcessTellsOfLies) {
  const std::string port = test::free_port();
  hal::linux_host::NamedBus bus;
  hal::linux_host::Reason reason;
  ASSERT_TRUE(bus.open(("slcan:listen:127.0.0.1:" + port).c_str(), {}, reason)) << reason.text;
  Publisher publisher;
  Diagnostics diagnostics(publisher.participant());
  processes::ChildProcess process({std::string(S4TP_BINARY_DIR) + "/sim_host/s4tp-telemetry", "--ecu",
                                   "/s4tp_no_such_" + std::to_string(getpid()), "--domain",
                                   std::to_string(tests::free_domain()), "--input",
                                   "slcan:tcp:127.0.0.1:" + port});
  std::vector<wire::Frame> arrived;
  const auto listen = [&] {
    (void)bus.can().wait(1);
    for (hal::CanFrame frame; bus.can().receive(frame);) arrived.push_back(to_wire(frame));
  };
  ASSERT_TRUE(wait_for([&] {
    listen();
    return publisher.heard() && bus.can().state() == hal::CanState::kActive;
  }));
  const wire::Tracks good = good_list();
  Arena arena;
  const auto tell = [&](const TrackedObjects& list, const char* what) {
    std::this_thread::sleep_for(2 * std::chrono::milliseconds(RateGuard::kApartMs));
    publisher.tell(list);
    ASSERT_TRUE(wait_for([&] {
      listen();
      return diagnostics.value(what) == 1.0;
    })) << what
        << ": " << diagnostics.value(what);
  };
  TrackedObjects list = message_of(good, arena);
  list.objects._buffer[1].kinematics.pose_with_covariance.pose.position.x =
      std::numeric_limits<double>::quiet_NaN();
  tell(list, "object lists: not a number");
  list = message_of(good, arena);
  list.header.frame_id = arena.text("base_link");
  tell(list, "object lists: wrong frame");
  EXPECT_TRUE(arrived.empty()) << arrived.size() << " frames of lies";

  tell(message_of(good, arena), "object lists: taken");
  ASSERT_TRUE(wait_for([&] {
    listen();
    return arrived.size() >= 5;
  }));
  EXPECT_EQ(arrived[0].id, wire::kTrackListId);
}

}  // namespace
}  // namespace s4tp::telemetry
