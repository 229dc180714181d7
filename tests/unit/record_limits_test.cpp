// Records from outside: what no campaign can have written is refused by name, in a moment.

#include "sim_host/campaign/record_limits.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>

#include "sim_host/campaign/compare.hpp"
#include "sim_host/campaign/episode_record.hpp"
#include "sim_host/campaign/records.hpp"
#include "sim_host/view/charts.hpp"
#include "tests/support/networks.hpp"

namespace s4tp::campaign {
namespace {

using nlohmann::ordered_json;
using test::Folder;

ordered_json header() {
  return ordered_json::parse(R"({"kind":"s4tp campaign","version":3,"planners":["blind"],
    "scenarios":[{"name":"merge","argument":"merge","digest":"0"}],"flavours":["smarts"],"traffic":["builtin"],"guard":["on"],
    "perception":"ideal","episodes":4,"first_seed":10,"parameters":"","parameters_crc":1,"wire_version":1,"build":"b",
    "cells":[["blind","merge","smarts","builtin",true,"ideal"]],"shard":"1/1"})");
}

ordered_json row(std::uint64_t seed = 10) {
  EpisodeRow one{{"blind", "merge", "smarts", "builtin", true, "ideal"}, {}};
  one.metrics.seed = seed;
  one.metrics.ending = traffic::Ending::kGoal;
  one.metrics.duration_s = 20.0;
  return to_json(one);
}

std::string error_of(const ordered_json& head, const ordered_json& line, const std::string& text = {}) {
  const Folder folder;
  try {
    (void)read_records(
        {folder.write("a.jsonl", head.dump() + "\n" + (text.empty() ? line.dump() : text) + "\n")});
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no error";
}

ordered_json with(ordered_json json, const char* key, const ordered_json& value) {
  json[key] = value;
  return json;
}

// FILE-004 Of 10^12 episodes, or -1, every one was counted; they are 1 to a million. A cell is there once.
TEST(RecordLimits, Headers) {
  EXPECT_EQ(error_of(header(), row()), "no error");
  for (const ordered_json& episodes : {ordered_json(1'000'000'000'000), ordered_json(-1), ordered_json(0),
                                       ordered_json(4.0), ordered_json("4"), ordered_json()}) {
    const std::string error = error_of(with(header(), "episodes", episodes), row());
    EXPECT_NE(error.find("episodes: " + episodes.dump() + "; accepted is a whole number from 1 to 1000000"),
              std::string::npos)
        << error;
  }
  EXPECT_NE(error_of(with(header(), "first_seed", -1), row()).find("first_seed"), std::string::npos);
  EXPECT_NE(error_of(with(header(), "first_seed", kSeedMax), row()).find("first_seed"), std::string::npos);
  EXPECT_NE(error_of(with(header(), "planners", ordered_json::array({7})), row()).find("planners"),
            std::string::npos);
  ordered_json twice = header();
  twice["cells"].push_back(twice["cells"][0]);
  EXPECT_NE(error_of(twice, row()).find("each cell once"), std::string::npos);
}

// FILE-004 A header without who perceives, or with a number for the parameters' file, failed only where it was
// used, without the file's name.
TEST(RecordLimits, EveryKeyAReaderNeeds) {
  ordered_json without = header();
  without.erase("perception");
  EXPECT_NE(error_of(without, row()).find("a.jsonl: line 1"), std::string::npos);
  EXPECT_NE(error_of(with(header(), "parameters", 7), row()).find("parameters: 7; accepted is a text"),
            std::string::npos);
}

// FILE-011 100,000 brackets in a header or in a result ended the program: printing and comparing recurse.
TEST(RecordLimits, NestingIsBounded) {
  const std::string deep = std::string(100'000, '[') + std::string(100'000, ']');
  const std::string head = test::replaced(header().dump(), "\"episodes\":4", "\"episodes\":" + deep);
  const Folder folder;
  try {
    (void)read_records({folder.write("a.jsonl", head + "\n")});
    ADD_FAILURE() << "no error";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("a.jsonl: line 1"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("nested more than 32 deep"), std::string::npos) << error.what();
  }
  EXPECT_THROW((void)parse_json(deep), std::runtime_error);
  EXPECT_EQ(parse_json("[[1]]"), ordered_json::parse("[[1]]"));
}

// FILE-004 A million episodes in each of many cells cost nothing to count: 5 to 8 and 7 to 1,000,006 are
// 1,000,002.
TEST(RecordLimits, PlannedSeedsAreCountedNotListed) {
  const Folder folder;
  const auto write = [&](const char* name, ordered_json head) { folder.write(name, head.dump() + "\n"); };
  write("a.jsonl", with(header(), "first_seed", 5));
  write("b.jsonl", with(with(header(), "first_seed", 7), "episodes", 1'000'000));
  EXPECT_EQ(read_records({folder.path()}).cells.at(0).planned, 1'000'002U);
}

// FILE-004 A drive of 1e308 s kept the chart's grid drawing for ever. Figures are finite and of a size;
// counts are whole, as neither float nor negative fits where they go.
TEST(RecordLimits, Figures) {
  EXPECT_NE(error_of(header(), with(row(), "duration_s", 1e308))
                .find("duration_s: 1e+308; accepted is a number from 0 to 7200"),
            std::string::npos)
      << error_of(header(), with(row(), "duration_s", 1e308));
  EXPECT_NE(error_of(header(), with(row(), "duration_s", -1.0)).find("duration_s"), std::string::npos);
  EXPECT_NE(error_of(header(), with(row(), "min_gap_m", 1e300)).find("min_gap_m"), std::string::npos);
  for (const ordered_json& count :
       {ordered_json(1e300), ordered_json(-1), ordered_json(0.5), ordered_json(3'000'000'000)}) {
    EXPECT_NE(error_of(header(), with(row(), "near_misses", count)).find("near_misses"), std::string::npos)
        << count;
    EXPECT_NE(error_of(header(), with(row(), "redrawn", count)).find("redrawn"), std::string::npos) << count;
  }
}

// The chart's grid has at most ten lines or so, whatever the longest drive.
TEST(RecordLimits, ChartsStaySmall) {
  for (const double duration_s : {1.0, 7'200.0, 1e300}) {
    CellResult cell{{}, {}, {{}}};
    cell.episodes[0].ending = traffic::Ending::kGoal;
    cell.episodes[0].duration_s = duration_s;
    cell.summary = metrics::summarize(cell.episodes);
    const std::string chart = view::outcome_chart({&cell});
    EXPECT_LT(chart.size(), 20'000U) << duration_s;
  }
}

// FILE-005 Episodes nobody planned went into the rates: seeds before, behind and below zero, and another
// cell.
TEST(RecordLimits, OnlyPlannedEpisodesCount) {
  EXPECT_EQ(error_of(header(), row(13)), "no error");
  for (const std::uint64_t seed : {9U, 14U}) {
    const std::string error = error_of(header(), row(seed));
    EXPECT_NE(error.find("line 2"), std::string::npos) << error;
    EXPECT_NE(error.find("seed " + std::to_string(seed) + " was never planned"), std::string::npos) << error;
  }
  EXPECT_NE(error_of(header(), with(row(), "seed", -3)).find("seed: -3; accepted is a whole number"),
            std::string::npos);
  EXPECT_NE(error_of(header(), with(row(), "planner", "s4tp")).find("no such cell"), std::string::npos);
}

ordered_json result(const std::vector<std::uint64_t>& failed) {
  ordered_json failures = ordered_json::array();
  for (const std::uint64_t seed : failed) failures.push_back({{"seed", seed}});
  const ordered_json run{{"planner", "blind"},   {"scenario", "merge"}, {"flavour", "smarts"},
                         {"traffic", "builtin"}, {"guarded", true},     {"perception", "ideal"},
                         {"episodes", 4},        {"failures", failures}};
  return {{"first_seed", 0}, {"episodes_per_run", 4}, {"runs", {run}}};
}

// FILE-006 A run that stands twice in a result counted its pairs twice; a failure with a seed that was not
// driven is no failure.
TEST(RecordLimits, ComparedRunsStandOnce) {
  EXPECT_EQ(outcomes_of(result({1, 3})).size(), 1U);
  ordered_json twice = result({1});
  twice["runs"].push_back(twice["runs"][0]);
  EXPECT_THROW((void)outcomes_of(twice), std::runtime_error);
  EXPECT_THROW((void)outcomes_of(result({4})), std::runtime_error);
  EXPECT_THROW((void)outcomes_of(with(result({}), "episodes_per_run", 1'000'000'000'000)),
               std::runtime_error);
  ordered_json many = with(result({}), "episodes_per_run", 1'000'000);
  many["runs"][0]["episodes"] = 1'000'000;
  for (const char* const name : {"a", "b", "c"}) {
    many["runs"].push_back(many["runs"][0]);
    many["runs"].back()["planner"] = name;
  }
  EXPECT_THROW((void)outcomes_of(many), std::runtime_error);
}

// FILE-008 One row of the report held episodes driven with different parameters; so for the wire, the build
// and the scenario's files. Cells that are not in both may stand beside each other.
TEST(RecordLimits, DifferentCampaignsAreNotPooled) {
  const auto error_with = [](ordered_json other) {
    const Folder folder;
    folder.write("a.jsonl", header().dump() + "\n");
    folder.write("b.jsonl", other.dump() + "\n");
    try {
      (void)read_records({folder.path()});
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  const ordered_json later = with(header(), "first_seed", 14);
  EXPECT_EQ(error_with(later), "no error");
  for (const char* const key : {"parameters_crc", "wire_version", "build"}) {
    EXPECT_NE(error_with(with(later, key, 2)).find(std::string("differ in ") + key), std::string::npos)
        << key;
  }
  ordered_json edited = later;
  edited["scenarios"][0]["digest"] = "1";
  EXPECT_NE(error_with(edited).find("differ in the files of merge"), std::string::npos) << error_with(edited);
  edited["cells"][0][0] = "s4tp";
  edited["parameters_crc"] = 2;
  EXPECT_EQ(error_with(edited), "no error");
}

}  // namespace
}  // namespace s4tp::campaign
