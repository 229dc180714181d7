// What the live view is told of a cycle, and whom its server answers; the page itself is looked at by
// tests/view.

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "sim_host/campaign/episode.hpp"
#include "sim_host/telemetry/live_cycle.hpp"
#include "sim_host/telemetry/live_drive.hpp"
#include "sim_host/telemetry/watch.hpp"
#include "sim_host/telemetry/web_access.hpp"
#include "sim_host/telemetry/who_matters.hpp"
#include "sim_host/view/plan_words.hpp"
#include "tests/support/drive_time.hpp"
#include "tests/support/test_memory.hpp"

namespace s4tp::telemetry {
namespace {

/// Keeps the cycles of a drive as a reader of the shared memory would see them.
class Keeper final : public campaign::Onlooker {
 public:
  struct Kept {
    ecu::PlanRecord plan;
    CycleRecord cycle;
  };
  Keeper() : name_(tests::test_memory("live_view")), watch_(name_) {}
  void begin(campaign::Trace* trace) override {
    tap_.emplace(trace, trace);
    hal::linux_host::Reason reason;
    ASSERT_TRUE(tap_->open(name_, "s4tp", "test", Parameters{}, reason)) << reason.text;
  }
  hal::Telemetry* telemetry() override { return &*tap_; }
  planner::Probe* probe() override { return &*tap_; }
  void ticked(const campaign::Driver& driver) override {
    tap_->note_status(driver.core(), driver.bus());
    if (watch_.look().plan && watch_.cycle() != nullptr) kept.push_back({watch_.plan(), *watch_.cycle()});
  }
  [[nodiscard]] const Watch& watch() const { return watch_; }

  std::vector<Kept> kept;

 private:
  std::string name_;
  std::optional<EcuTap> tap_;
  Watch watch_;
};

/// The left turn of seed 7, where cars from both sides are waited for.
const Keeper& left_turn() {
  static const std::unique_ptr<Keeper> keeper = [] {
    auto made = std::make_unique<Keeper>();
    const scenario::Scenario scenario =
        scenario::load_scenario(std::filesystem::path(S4TP_SOURCE_DIR) / "sim_host/scenarios/left_turn");
    campaign::EpisodeOptions options;
    options.seed = 7;
    options.onlooker = made.get();
    (void)campaign::run_episode(scenario, options);
    return made;
  }();
  return *keeper;
}

// VIEW-010 VIEW-012 In a drive that waits: whom the words name is who blocks us, by track, with its belief
// and its claim.
TEST(LiveCycle, SaysWhoBlocksUs) {
  int waits = 0;
  for (const Keeper::Kept& one : left_turn().kept) {
    const nlohmann::ordered_json json = cycle_json(one.plan, one.cycle, {}, Parameters{}, nullptr);
    const campaign::CycleTrace trace = trace_of(one.plan, &one.cycle, {});
    const view::Reason reason = view::reason_of(trace);
    EXPECT_EQ(json.at("words"), view::in_words(trace));
    const auto& who = json.at("who");
    EXPECT_EQ(who.at("blocks").get<bool>(), reason.track >= 0);
    if (reason.because == view::Because::kGivingWay && reason.track >= 0) {
      ++waits;
      EXPECT_EQ(who.at("id").get<int>(), reason.track);
      EXPECT_NE(json.at("words").get<std::string>().find(who.at("name").get<std::string>()),
                std::string::npos);
    }
  }
  EXPECT_GT(waits, 100);
}

// VIEW-010 Each claim has its words: of who comes, how soon, and that we are through before, where we are.
TEST(LiveCycle, ClaimsHaveWords) {
  using safety::Claim;
  const auto words = [](Claim claim, float from_s, float we_leave_s) {
    return claim_words({{.claim = claim, .from_s = from_s}, we_leave_s});
  };
  EXPECT_EQ(words(Claim::kNone, 1.0F, 1.0F), "");
  EXPECT_EQ(words(Claim::kMayCome, 3.6F, 3.4F),
            "need not wait for us: it can be there in 3.6 s; we are out of its way in 3.4 s");
  EXPECT_EQ(words(Claim::kMayCome, 3.6F, 3.8F), "need not wait for us: it can be there in 3.6 s");
  EXPECT_EQ(words(Claim::kMayCome, 0.0F, 3.8F), "is where our ways meet");
  EXPECT_EQ(words(Claim::kOwes, 1.0F, 2.0F), "owes us the way: it has to stop for us");
  for (const Claim claim : {Claim::kCanStop, Claim::kStands})
    EXPECT_NE(words(claim, 1.0F, 2.0F).find("it leaves us the way"), std::string::npos);
}

// VIEW-012 Numbers are the record's: vehicles by track, 16 points a plan, a line a candidate, probabilities of
// a vehicle's futures add up; the cheapest candidate has part 0, the dearest 1; lines are finite.
TEST(LiveCycle, TellsTheRecordsNumbers) {
  const Keeper::Kept& one = left_turn().kept.at(left_turn().kept.size() / 2);
  const auto map = std::make_unique<sadrf::HeatMap>(heat_map_of(one.plan, one.cycle, Parameters{}));
  const nlohmann::ordered_json json = cycle_json(one.plan, one.cycle, {}, Parameters{}, map.get());
  EXPECT_EQ(json.at("t"), one.plan.plan.start_ms);
  ASSERT_EQ(static_cast<int>(json.at("vehicles").size()), one.cycle.scene.agents.size());
  EXPECT_EQ(json.at("vehicles").at(0).at("id"), one.cycle.scene.agents[0].track.id);
  EXPECT_NEAR(json.at("vehicles").at(0).at("x").get<double>(), one.cycle.scene.agents[0].track.centre.x_m,
              0.006);
  EXPECT_EQ(json.at("plan").size(), 32U);
  EXPECT_EQ(static_cast<int>(json.at("candidates").size()), one.cycle.candidates.size());
  double least = 2.0;
  double most = -1.0;
  for (const auto& candidate : json.at("candidates")) {
    EXPECT_EQ(candidate.at("line").size(), 32U);
    EXPECT_EQ(candidate.at("part").is_null(), !candidate.at("why").get<std::string>().empty());
    if (candidate.at("part").is_null()) continue;
    least = std::min(least, candidate.at("part").get<double>());
    most = std::max(most, candidate.at("part").get<double>());
  }
  EXPECT_EQ(least, 0.0);
  EXPECT_LE(most, 1.0);
  EXPECT_EQ(json.at("haze").at("columns"), sadrf::kHeatColumns);
  EXPECT_EQ(json.at("stages").size(), static_cast<std::size_t>(planner::kStageCount));
  EXPECT_EQ(json.dump().find("null,null"), std::string::npos) << "a coordinate is not finite";
}

// TELE-013 TELE-014 Shares of the risk add up to all of it wherever there is any, and most of it is whose
// share of one step is largest; a vehicle whose way does not meet ours claims nothing.
TEST(LiveCycle, SharesAddUp) {
  int shared = 0;
  int agree = 0;
  int unclaimed = 0;
  for (std::size_t i = 0; i < left_turn().kept.size(); i += 10) {
    const Keeper::Kept& one = left_turn().kept[i];
    const std::vector<float> shares = risk_shares(one.plan, one.cycle, Parameters{});
    ASSERT_EQ(static_cast<int>(shares.size()), one.cycle.scene.agents.size());
    const float sum = std::accumulate(shares.begin(), shares.end(), 0.0F);
    for (const GroundClaim& claim : claims_of(one.plan, one.cycle, Parameters{}))
      unclaimed += claim.its.claim == safety::Claim::kNone ? 1 : 0;
    if (sum == 0.0F) continue;
    EXPECT_NEAR(sum, 1.0F, 1e-4F);
    ++shared;
    const auto largest = static_cast<int>(std::max_element(shares.begin(), shares.end()) - shares.begin());
    agree += one.cycle.scene.agents[largest].track.id == one.plan.explanation.dominating_track ? 1 : 0;
  }
  EXPECT_GT(shared, 10);
  EXPECT_GT(agree, shared * 8 / 10);
  EXPECT_GT(unclaimed, 0);
}

// VIEW-011 Faults are named, each by its bit's words; the bus has its counters.
TEST(LiveCycle, TellsModeAndFaults) {
  ecu::ControlRecord control;
  control.mode = ecu::Mode::kDegraded;
  control.faults = ecu::bit(ecu::FaultBit::kTracksStale) | ecu::bit(ecu::FaultBit::kPlanLate);
  StatusRecord status;
  status.bus.dropped = 3;
  const nlohmann::ordered_json json = ecu_json(left_turn().watch().identity(), control, status);
  EXPECT_EQ(json.at("mode"), ecu::mode_name(ecu::Mode::kDegraded));
  EXPECT_EQ(json.at("faults"), (std::vector<std::string>{ecu::fault_name(4), ecu::fault_name(9)}));
  EXPECT_EQ(json.at("dropped"), 3);
  EXPECT_EQ(json.at("planner"), "s4tp");
}

// TELE-005 Looked at or not, at the pace of the clock or not, the drive is the same.
TEST(LiveDrive, IsTheSameDrive) {
  const scenario::Scenario scenario = tests::shipped_for("cruise", 4.0);
  campaign::EpisodeOptions options;
  options.trace = true;
  const auto begin = std::chrono::steady_clock::now();
  const campaign::EpisodeResult plain = campaign::run_episode(scenario, options);
  const auto middle = std::chrono::steady_clock::now();
  LiveDrive live(tests::test_memory("live_drive"), "s4tp", options.parameters);
  options.onlooker = &live;
  const campaign::EpisodeResult shown = campaign::run_episode(scenario, options);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - middle;
  ASSERT_EQ(plain.trace->cycles.size(), shown.trace->cycles.size());
  for (std::size_t i = 0; i < plain.trace->cycles.size(); ++i)
    ASSERT_EQ(plain.trace->cycles[i].record.digest, shown.trace->cycles[i].record.digest) << i;
  EXPECT_GE(took.count(), 0.095 * static_cast<double>(plain.trace->cycles.size()));
  EXPECT_LT(middle - begin, took);
}

// VIEW-020 Only our port under a name that no stranger can take; on any address, addresses in digits.
TEST(WebAccess, TakesOwnHostsOnly) {
  const WebAccess here("127.0.0.1", 8470);
  for (const char* const host : {"127.0.0.1:8470", "localhost:8470", "LocalHost:8470", "[::1]:8470"})
    EXPECT_TRUE(here.takes_host(host)) << host;
  for (const char* const host :
       {"", ":", ":8470", "127.0.0.1", "localhost", "127.0.0.1:80", "127.0.0.1:84700", "evil.example:8470",
        "localhost.evil.example:8470", "127.0.0.1:8470:8470", "10.0.0.5:8470", "[::1]", "127.0.0.1:8470 ",
        "localhost:8470@evil.example", "evil.example#localhost:8470", "0.0.0.0:8470", "2130706433:8470"})
    EXPECT_FALSE(here.takes_host(host)) << host;
  EXPECT_TRUE(WebAccess("127.0.0.1", 80).takes_host("localhost"));
  const WebAccess named("10.0.0.5", 8470);
  EXPECT_TRUE(named.takes_host("10.0.0.5:8470"));
  EXPECT_FALSE(named.takes_host("10.0.0.6:8470"));
  const WebAccess any("0.0.0.0", 8470);
  EXPECT_TRUE(any.takes_host("10.0.0.6:8470"));
  EXPECT_TRUE(any.takes_host("[fe80::1]:8470"));
  EXPECT_FALSE(any.takes_host("evil.example:8470"));
  EXPECT_FALSE(any.takes_host("10.0.0.6.evil.example:8470"));
}

// VIEW-021 A page of the same place, or no page at all.
TEST(WebAccess, TakesOwnPagesOnly) {
  const WebAccess here("127.0.0.1", 8470);
  EXPECT_TRUE(here.takes_origin("", "localhost:8470"));
  EXPECT_TRUE(here.takes_origin("http://localhost:8470", "localhost:8470"));
  for (const char* const origin :
       {"null", "http://evil.example", "https://localhost:8470", "http://localhost", "http://localhost:84700",
        "http://127.0.0.1:8470", "file://"})
    EXPECT_FALSE(here.takes_origin(origin, "localhost:8470")) << origin;
}

}  // namespace
}  // namespace s4tp::telemetry
