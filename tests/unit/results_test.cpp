// Rows, records and comparisons without driving.

#include "sim_host/campaign/results.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "sim_host/campaign/compare.hpp"
#include "sim_host/campaign/episode_record.hpp"
#include "sim_host/campaign/progress.hpp"

namespace s4tp::campaign {
namespace {

EpisodeRow row(const std::string& planner, std::uint64_t seed, bool fails) {
  EpisodeRow one;
  one.cell.planner = planner;
  one.cell.scenario = "merge";
  one.metrics.seed = seed;
  one.metrics.ending = fails ? traffic::Ending::kTimeOut : traffic::Ending::kGoal;
  one.metrics.cause = fails ? "time-out" : "goal";
  one.metrics.duration_s = 0.1 + 1.0 / 3.0;
  one.metrics.comp1.jerk_linear = 1e-17;
  return one;
}

nlohmann::ordered_json header(int episodes) {
  return {{"kind", "s4tp campaign"},
          {"version", 3},
          {"planners", {"a", "b"}},
          {"scenarios", {{{"name", "merge"}, {"argument", "merge"}, {"digest", "0"}}}},
          {"flavours", {"smarts"}},
          {"traffic", {"builtin"}},
          {"guard", {"on"}},
          {"perception", "ideal"},
          {"episodes", episodes},
          {"first_seed", 0},
          {"cells",
           {{"a", "merge", "smarts", "builtin", true, "ideal"},
            {"b", "merge", "smarts", "builtin", true, "ideal"}}},
          {"parameters", ""},
          {"parameters_crc", 1},
          {"wire_version", 1},
          {"build", "0"},
          {"shard", "1/1"}};
}

std::filesystem::path scratch(const std::string& name) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / ("s4tp_results_" + name);
  std::filesystem::remove(file);
  return file;
}

// Every number comes back to the bit, thirds and tiny ones too.
TEST(EpisodeRecord, RowsComeBackToTheBit) {
  const EpisodeRow before = row("a", 7, true);
  const EpisodeRow after = row_of(to_json(before));
  EXPECT_EQ(after.cell, before.cell);
  EXPECT_EQ(after.metrics.duration_s, before.metrics.duration_s);
  EXPECT_EQ(after.metrics.comp1.jerk_linear, before.metrics.comp1.jerk_linear);
  EXPECT_EQ(after.metrics.ending, traffic::Ending::kTimeOut);
  EXPECT_EQ(to_json(after), to_json(before));
}

// A record of the program before has other metrics: it is refused, with both versions and what to do. So is one whose version is
// no number of ours: no integer holds the third.
TEST(EpisodeRecord, OlderRecordsAreRefused) {
  const std::filesystem::path file = scratch("older");
  for (const auto& [said, told] : {std::pair{"", "version 1 "},
                                   {R"(, "version": "two")", R"(version "two" )"},
                                   {R"(, "version": 92233720368547758072)", "version 9.22"}}) {
    std::ofstream(file) << R"({"kind": "s4tp campaign", "planners": ["a"])" << said << "}\n";
    try {
      (void)read_part(file);
      FAIL();
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find(told), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("drive it again"), std::string::npos) << error.what();
    }
  }
}

// Half a line at the end is dropped, what was whole is found again; a broken line before the end is named.
TEST(EpisodeRecord, GoesOnAfterACrash) {
  const std::filesystem::path file = scratch("crash");
  { EpisodeRecord(file, header(2)).append(row("a", 0, false)); }
  std::ofstream(file, std::ios::app) << R"({"planner": "a", "sce)";
  {
    EpisodeRecord record(file, header(2));
    ASSERT_EQ(record.found().size(), 1U);
    record.append(row("a", 1, false));
  }
  EXPECT_EQ(read_part(file).rows.size(), 2U);
  std::ofstream(file, std::ios::app) << "nonsense\n";
  try {
    (void)read_part(file);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("line 4"), std::string::npos) << error.what();
  }
}

// Two campaigns cannot write one record.
TEST(EpisodeRecord, HasOneWriter) {
  const std::filesystem::path file = scratch("lock");
  const EpisodeRecord first(file, header(2));
  EXPECT_THROW(EpisodeRecord(file, header(2)), std::runtime_error);
}

// An episode in two parts counts once when it is the same, and is refused when it is not.
TEST(Results, AnEpisodeCountsOnce) {
  EXPECT_EQ(collect({row("a", 0, false), row("a", 0, false)}).front().episodes.size(), 1U);
  EXPECT_THROW((void)collect({row("a", 0, false), row("a", 0, true)}), std::runtime_error);
}

// Whatever order episodes finished in, the document is the same.
TEST(Results, OrderDoesNotMatter) {
  const std::vector<EpisodeRow> rows{row("a", 0, true), row("a", 1, false), row("b", 0, false),
                                     row("b", 1, false)};
  const std::vector<EpisodeRow> others{rows[3], rows[1], rows[0], rows[2]};
  const auto document = results_json(header(2), collect(rows, header(2)));
  EXPECT_EQ(document.dump(), results_json(header(2), collect(others, header(2))).dump());
  EXPECT_EQ(document.at("runs").at(0).at("failures").at(0).at("seed"), 0);
  EXPECT_EQ(document.at("runs").at(0).at("success_rate"), 0.5);
  EXPECT_EQ(document.at("episodes_done"), 4);
}

// Pairs from the document alone: a fails at seeds 0 and 2, b at 2: one pair where only a fails.
TEST(Compare, PairsBySeed) {
  std::vector<EpisodeRow> rows;
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    rows.push_back(row("a", seed, seed != 1));
    rows.push_back(row("b", seed, seed == 2));
  }
  const auto outcomes = outcomes_of(results_json(header(3), collect(rows, header(3))));
  const std::vector<ComparedCell> cells = pair_up(outcomes, "a", outcomes, "b");
  ASSERT_EQ(cells.size(), 1U);
  EXPECT_EQ(cells[0].paired.pairs, 3);
  EXPECT_EQ(cells[0].paired.only_first_fails, 1);
  EXPECT_EQ(cells[0].paired.only_second_fails, 0);
  const auto json = comparison_json(cells);
  EXPECT_EQ(json.at(0).at("only_first_fails"), 1);
  EXPECT_EQ(json.at(0).at("first_is"), "open");
}

// A run of which episodes are missing does not say which: it cannot be paired.
TEST(Compare, RefusesIncompleteRuns) {
  const auto document = results_json(header(3), collect({row("a", 0, false)}, header(3)));
  EXPECT_THROW((void)outcomes_of(document), std::runtime_error);
}

// Only what differs from the defaults is in the command; what a shell would take apart is quoted.
TEST(Cell, ReplayCommand) {
  Cell cell;
  EXPECT_EQ(replay_command(cell, "merge", "", 7), "./s4tp run --scenario merge --seed 7 --planner s4tp");
  cell = {"blind", "mine", "social", "sumo", false, "real"};
  EXPECT_EQ(
      replay_command(cell, "my roads/it's", "p.toml", 10000),
      "./s4tp run --scenario 'my roads/it'\\''s' --seed 10000 --planner blind --guard off --flavour social "
      "--traffic sumo --perception real --parameters p.toml");
}

// 4 of 10 were done; 2 more took 30 s: 4 to go at 15 s each is a minute.
TEST(Progress, TimeLeft) {
  std::ostringstream bar;
  Progress progress(bar, true, 10, 4);
  progress.done(15.0, "");
  bar.str("");
  progress.done(30.0, "merge");
  EXPECT_NE(bar.str().find("6/10, 60 s left  merge"), std::string::npos) << bar.str();
}

// Without a terminal: no control characters, and not a line an episode: the first, one every 10 s, the last.
TEST(Progress, PlainLines) {
  std::ostringstream out;
  Progress progress(out, false, 100, 0);
  for (int i = 1; i <= 100; ++i) progress.done(i, "x");
  progress.end();
  const std::string text = out.str();
  EXPECT_EQ(text.find_first_of("\r\x1b"), std::string::npos);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 11);  // at 1, 11, 21 .. 91 and 100 s
}

// Rounded as people say it.
TEST(Progress, RoughTime) {
  EXPECT_EQ(rough_time(45.0), "45 s");
  EXPECT_EQ(rough_time(600.0), "10 min");
  EXPECT_EQ(rough_time(12000.0), "3 h 20 min");
}

}  // namespace
}  // namespace s4tp::campaign
