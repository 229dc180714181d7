// A replay is the drive that was recorded, told in numbers; the page itself is looked at by report_test.py.

#include "sim_host/view/replay.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "sim_host/metrics/metrics.hpp"
#include "sim_host/view/haze.hpp"
#include "sim_host/view/html.hpp"

namespace s4tp::view {
namespace {

struct Drive {
  scenario::Scenario scenario;
  campaign::EpisodeResult result;
  campaign::EpisodeRow row;
};

Drive drive(const std::string& planner, bool guarded, std::uint64_t seed) {
  const std::filesystem::path shipped = std::filesystem::path(S4TP_SOURCE_DIR) / "sim_host" / "scenarios";
  Drive one{scenario::load_scenario(shipped / "overtake"), {}, {}};
  campaign::EpisodeOptions options;
  options.planner = planner;
  options.guarded = guarded;
  options.seed = seed;
  options.trace = true;
  one.result = campaign::run_episode(one.scenario, options);
  one.row = {{planner, "overtake", "smarts", "builtin", guarded, "ideal"},
             metrics::evaluate(one.result.recording, one.scenario)};
  return one;
}

// VIEW-001 Driven twice, every number comes out again; another seed is told apart by what differs, in words.
TEST(Replay, SameSeedChangesNothing) {
  const Drive first = drive("constant_speed", false, 1);
  const Drive again = drive("constant_speed", false, 1);
  EXPECT_EQ(changed(first.row, again.row), "");

  campaign::EpisodeRow other = again.row;
  other.metrics.duration_s += 0.01;
  EXPECT_EQ(changed(first.row, other).rfind("duration_s: ", 0), 0U) << changed(first.row, other);
  EXPECT_NE(changed(first.row, other).find(" then, "), std::string::npos);
}

// The last frame told is the last one recorded: where the ego ended, in units of 5 cm from the origin, and
// when.
TEST(Replay, TellsTheRecordedStates) {
  const Drive one = drive("s4tp", true, 1);
  const nlohmann::ordered_json data = replay_data({one.scenario, one.result, one.row, "", {}});
  const traffic::Snapshot& last = one.result.recording.snapshots.back();
  const auto& frame = data.at("frames").back();
  EXPECT_NEAR(frame.at("t").get<double>(), 1000.0 * last.time_s, 0.5);
  EXPECT_NEAR(frame.at("ego").at(0).get<double>() * 0.05 + one.result.origin.x, last.ego.centre.x, 0.026);
  EXPECT_NEAR(frame.at("ego").at(1).get<double>() * 0.05 + one.result.origin.y, last.ego.centre.y, 0.026);
  EXPECT_EQ(frame.at("cars").size(), 5 * last.others.size());

  // A plan every 100 ms from take-over on, each with words, or those of the one before.
  const auto& cycles = data.at("cycles");
  ASSERT_GT(cycles.size(), 20U);
  EXPECT_TRUE(cycles.front().contains("words"));
  for (std::size_t i = 1; i < cycles.size(); ++i) {
    EXPECT_EQ(cycles[i].at("t").get<int>() - cycles[i - 1].at("t").get<int>(), 100);
    EXPECT_EQ(cycles[i].at("plan").size(), 2U * 16U);  // 3 s, every second of 31 points
  }
}

// A car alone has its risk before it and nowhere else; without cars there is nothing to paint.
TEST(Replay, HazeLiesBeforeACar) {
  EXPECT_EQ(Haze({}, {}).grid({-5.0, -5.0}, {5.0, 5.0}, 1.0), "");
  traffic::CarState car;
  car.speed_mps = 10.0;
  const Haze haze({car}, {});
  EXPECT_GT(haze.at({10.0, 0.0}), 0.1);
  EXPECT_EQ(haze.at({-10.0, 0.0}), 0.0);
  EXPECT_EQ(haze.at({0.0, 40.0}), 0.0);
  // 10 x 1 cells behind it: nothing at all; before it: as many letters as cells when counts are written out.
  EXPECT_EQ(haze.grid({-20.0, -0.5}, {-10.0, 0.5}, 1.0), "");
  EXPECT_NE(haze.grid({0.0, -0.5}, {10.0, 0.5}, 1.0), "");
}

// What comes from files, names of scenarios say, cannot become part of a page.
TEST(Replay, NamesAreText) {
  EXPECT_EQ(escaped("<b a=\"1\">&"), "&lt;b a=&quot;1&quot;&gt;&amp;");
  EXPECT_EQ(replay_name({"s4tp", "a/b c", "smarts", "builtin", false, "ideal"}, 7),
            "a-b-c_s4tp_bare_smarts_builtin_ideal_7.html");
}

// RFC 4648, section 10, over zlib: three bytes become four digits, and what is short is filled with "=".
TEST(Replay, DataIsBase64) {
  for (const char* const text : {"", "a", "ab", "abc", "abcd"}) {
    const std::string data = packed(text);
    EXPECT_EQ(data.size() % 4, 0U);
    EXPECT_EQ(data.rfind("eN", 0), 0U);  // 0x78 0xDA: deflate, best compression
  }
  EXPECT_LT(packed(std::string(9000, 'x')).size(), 100U);
}

}  // namespace
}  // namespace s4tp::view
