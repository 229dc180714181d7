// Records of several campaigns read together, as a report does.

#include "sim_host/campaign/records.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "sim_host/campaign/episode_record.hpp"

namespace s4tp::campaign {
namespace {

namespace fs = std::filesystem;

class ReadRecords : public testing::Test {
 protected:
  ReadRecords()
      : folder_(fs::path(testing::TempDir()) /
                ("s4tp_records_" +
                 std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + "_" +
                 std::to_string(getpid()))) {
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "a");
    fs::create_directories(folder_ / "b");
  }
  ~ReadRecords() override { fs::remove_all(folder_); }

  static nlohmann::ordered_json header(const std::vector<std::string>& planners, int episodes) {
    CampaignPlan plan;
    plan.planners = planners;
    plan.scenarios = {"overtake"};
    plan.guards = {false};
    plan.episodes = episodes;
    plan.first_seed = 5;
    return header_of(load_campaign(plan, fs::path(S4TP_SOURCE_DIR) / "sim_host" / "scenarios"), {}, "");
  }

  /// A record of constant_speed's episodes with these seeds.
  static void write(const fs::path& file, const nlohmann::ordered_json& header,
                    const std::vector<std::uint64_t>& seeds, double duration_s = 12.0) {
    EpisodeRecord record(file, header);
    for (const std::uint64_t seed : seeds) {
      EpisodeRow row{{"constant_speed", "overtake", "smarts", "builtin", false, "ideal"}, {}};
      row.metrics.seed = seed;
      row.metrics.ending = traffic::Ending::kGoal;
      row.metrics.duration_s = duration_s;
      record.append(row);
    }
  }

  fs::path folder_;
};

// One campaign has seeds 5 and 6 of a cell, a larger one 5 to 8, of which 5 and 7 are done: 3 of 4. Its other
// cell has none of its 4 yet. Folders, records and the numbers beside them are taken alike.
TEST_F(ReadRecords, CellsOfSeveralCampaignsJoin) {
  write(folder_ / "a" / "episodes.jsonl", header({"constant_speed"}, 2), {5, 6});
  write(folder_ / "b" / "part-1-of-2.jsonl", header({"constant_speed", "blind"}, 4), {7, 5});
  std::ofstream(folder_ / "b" / "results.json") << "{}";
  for (const fs::path& b :
       {folder_ / "b", folder_ / "b" / "part-1-of-2.jsonl", folder_ / "b" / "results.json"}) {
    const Records records = read_records({folder_ / "a", b});
    ASSERT_EQ(records.headers.size(), 2U);
    ASSERT_EQ(records.cells.size(), 2U);
    EXPECT_EQ(records.cells[0].planned, 4U);
    ASSERT_EQ(records.cells[0].result.episodes.size(), 3U);
    EXPECT_EQ(records.cells[0].result.episodes[2].seed, 7U);
    EXPECT_EQ(records.cells[0].result.summary.success.count, 3);
    EXPECT_TRUE(records.cells[1].result.episodes.empty());
    EXPECT_EQ(records.done(), 3U);
    EXPECT_EQ(records.planned(), 8U);
  }
}

// The same episode with two outcomes cannot both be true.
TEST_F(ReadRecords, TwoOutcomesOfOneEpisodeAreRefused) {
  write(folder_ / "a" / "episodes.jsonl", header({"constant_speed"}, 2), {5}, 12.0);
  write(folder_ / "b" / "episodes.jsonl", header({"constant_speed"}, 4), {5}, 13.0);
  try {
    (void)read_records({folder_ / "a", folder_ / "b"});
    FAIL() << "taken";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("seed 5"), std::string::npos) << error.what();
  }
}

// A folder without a record, and one that is not there, are named.
TEST_F(ReadRecords, WhatIsMissingIsNamed) {
  for (const char* const name : {"a", "nowhere"}) {
    try {
      (void)read_records({folder_ / name});
      FAIL() << "taken";
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find((folder_ / name).string()), std::string::npos) << error.what();
    }
  }
}

// A header says all that is needed to drive its campaign again.
TEST_F(ReadRecords, PlanComesBackFromItsHeader) {
  const nlohmann::ordered_json wanted = header({"constant_speed", "blind"}, 3);
  const Campaign again = load_campaign(plan_of(wanted), fs::path(S4TP_SOURCE_DIR) / "sim_host" / "scenarios");
  EXPECT_EQ(difference(header_of(again, {}, ""), wanted), "");
  EXPECT_EQ(header_of(again, {}, "").at("cells"), wanted.at("cells"));
  EXPECT_EQ(replay_command(wanted, again.cells[0].cell, 6),
            "./s4tp run --scenario overtake --seed 6 --planner constant_speed --guard off");
}

}  // namespace
}  // namespace s4tp::campaign
