// Campaigns through the tool, as a user starts them: killed and gone on with, in parts, on many threads.

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/content.hpp"

namespace s4tp {
namespace {

namespace fs = std::filesystem;
using test::content;

/// A folder of this test's own, empty.
fs::path scratch() {
  const auto* const info = testing::UnitTest::GetInstance()->current_test_info();
  const fs::path folder = fs::path(testing::TempDir()) /
                          ("s4tp_campaign_" + std::string(info->name()) + "_" + std::to_string(getpid()));
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

/// Starts `s4tp_tool eval ...`; all it says goes to `said`.
pid_t start(const std::vector<std::string>& arguments, const fs::path& said) {
  std::vector<std::string> words{fs::path(S4TP_BINARY_DIR) / "sim_host" / "s4tp_tool", "eval"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  const pid_t child = fork();
  if (child == 0) {
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    if (freopen(said.c_str(), "w", stdout) == nullptr || dup2(STDOUT_FILENO, STDERR_FILENO) < 0) _exit(126);
    execv(argv[0], argv.data());
    _exit(127);
  }
  return child;
}

/// \return exit code, or 128 + signal
int wait_for(pid_t child) {
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

int eval(const std::vector<std::string>& arguments, const fs::path& said) {
  return wait_for(start(arguments, said));
}

/// A small campaign of planners that cost little, and fail here and there when bare.
std::vector<std::string> campaign(const fs::path& out, const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments{
      "--planner", "constant_speed,blind", "--scenarios", "overtake,cruise", "--guard",
      "on,off",    "--episodes",           "3",           "--out",           out};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

std::size_t lines(const fs::path& file) {
  const std::string text = content(file);
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

// The same campaign on one and on three threads: the same bytes; with the keys the report is made from.
TEST(Campaign, BytesDoNotDependOnThreads) {
  const fs::path folder = scratch();
  ASSERT_EQ(eval(campaign(folder / "one", {"--jobs", "1"}), folder / "said"), 0) << content(folder / "said");
  ASSERT_EQ(eval(campaign(folder / "three", {"--jobs", "3"}), folder / "said"), 0)
      << content(folder / "said");
  const std::string one = content(folder / "one" / "results.json");
  EXPECT_EQ(one, content(folder / "three" / "results.json"));

  const nlohmann::json document = nlohmann::json::parse(one);
  ASSERT_EQ(document.at("runs").size(), 8U);
  for (const auto& run : document.at("runs")) {
    for (const char* const key :
         {"planner", "scenario", "flavour", "traffic", "guarded", "perception", "episodes", "success_rate",
          "wilson_low", "wilson_high", "collision_rate", "at_fault_collision_rate", "off_road_rate",
          "timeout_rate", "seconds_to_goal_mean", "min_ttc_s_p05", "comp1", "failures"}) {
      EXPECT_TRUE(run.contains(key)) << key;
    }
    EXPECT_EQ(run.at("episodes"), 3);
  }
}

// Killed while it drives, with half a line at the end of its record as a crash may leave it: the same command
// goes on from what is there, and ends with the bytes of a campaign nobody disturbed.
TEST(Campaign, KilledGoesOnToTheSameBytes) {
  const fs::path folder = scratch();
  ASSERT_EQ(eval(campaign(folder / "whole"), folder / "said"), 0);

  const fs::path record = folder / "killed" / "episodes.jsonl";
  const pid_t child = start(campaign(folder / "killed", {"--jobs", "1"}), folder / "said");
  for (int i = 0; i < 30'000 && (!fs::exists(record) || lines(record) < 4); ++i) usleep(2'000);
  kill(child, SIGKILL);
  (void)wait_for(child);
  ASSERT_GE(lines(record), 4U);
  std::ofstream(record, std::ios::app) << "{\"planner\":\"blind\",\"scen";

  ASSERT_EQ(eval(campaign(folder / "killed"), folder / "said"), 0) << content(folder / "said");
  EXPECT_NE(content(folder / "said").find("going on: "), std::string::npos);
  EXPECT_EQ(content(folder / "killed" / "results.json"), content(folder / "whole" / "results.json"));
  EXPECT_EQ(lines(record), 25U);  // a header and 24 episodes, each once
}

// Ctrl-C: the episodes that run are finished and kept, and it says how to go on; code 130.
TEST(Campaign, InterruptedSaysHowToGoOn) {
  const fs::path folder = scratch();
  const fs::path record = folder / "out" / "episodes.jsonl";
  const std::vector<std::string> arguments = campaign(folder / "out", {"--jobs", "1", "--first-seed", "7"});
  const pid_t child = start(arguments, folder / "said");
  for (int i = 0; i < 30'000 && (!fs::exists(record) || lines(record) < 2); ++i) usleep(2'000);
  kill(child, SIGINT);
  const int code = wait_for(child);
  if (lines(record) < 25U) {  // it was not too fast for us
    EXPECT_EQ(code, 130);
    EXPECT_NE(content(folder / "said").find("The same command goes on."), std::string::npos);
  }
  EXPECT_EQ(eval(arguments, folder / "said"), 0);
}

// Going on with other options is refused, and the difference named; code 2, and the record is untouched.
TEST(Campaign, OtherOptionsAreRefused) {
  const fs::path folder = scratch();
  ASSERT_EQ(eval(campaign(folder / "out"), folder / "said"), 0);
  const std::string before = content(folder / "out" / "episodes.jsonl");
  EXPECT_EQ(eval(campaign(folder / "out", {"--perception", "real"}), folder / "said"), 2);
  EXPECT_NE(content(folder / "said").find("perception: \"ideal\" there, \"real\" here"), std::string::npos)
      << content(folder / "said");
  std::ofstream(folder / "careful.toml") << "[comfort]\nheadway_s = 2.0\n";
  EXPECT_EQ(eval(campaign(folder / "out", {"--parameters", folder / "careful.toml"}), folder / "said"), 2);
  EXPECT_NE(content(folder / "said").find("parameters_crc"), std::string::npos);
  EXPECT_EQ(content(folder / "out" / "episodes.jsonl"), before);
}

// Three parts joined are the bytes of one run; two of them say how much is done, code 1; a part of another
// campaign is refused.
TEST(Campaign, PartsJoinToTheSameBytes) {
  const fs::path folder = scratch();
  ASSERT_EQ(eval(campaign(folder / "whole"), folder / "said"), 0);
  std::vector<std::string> parts;
  for (const std::string i : {"1", "2", "3"}) {
    ASSERT_EQ(eval(campaign(folder / "parts", {"--shard", i + "/3"}), folder / "said"), 0);
    parts.push_back(folder / "parts" / ("part-" + i + "-of-3.jsonl"));
  }
  const fs::path json = folder / "merged.json";
  EXPECT_EQ(eval({"merge", parts[2], parts[0], parts[1], "--json", json}, folder / "said"), 0);
  EXPECT_NE(content(folder / "said").find("24 of 24 episodes done"), std::string::npos);
  EXPECT_EQ(content(json), content(folder / "whole" / "results.json"));

  EXPECT_EQ(eval({"merge", parts[0], parts[1], "--json", json}, folder / "said"), 1);
  EXPECT_NE(content(folder / "said").find("16 of 24 episodes done"), std::string::npos);

  ASSERT_EQ(eval(campaign(folder / "other", {"--shard", "3/3", "--first-seed", "9"}), folder / "said"), 0);
  EXPECT_EQ(
      eval({"merge", parts[0], folder / "other" / "part-3-of-3.jsonl", "--json", json}, folder / "said"), 2);
  EXPECT_NE(content(folder / "said").find("first_seed: 9 there, 0 here"), std::string::npos)
      << content(folder / "said");
}

// A listed failure's command drives the same failure again: same planner, seed, and time of the touch.
TEST(Campaign, FailuresReplay) {
  const fs::path folder = scratch();
  ASSERT_EQ(eval({"--planner", "blind", "--scenarios", "overtake", "--guard", "off", "--episodes", "2",
                  "--out", folder / "out"},
                 folder / "said"),
            0);
  const nlohmann::json run = nlohmann::json::parse(content(folder / "out" / "results.json")).at("runs").at(0);
  ASSERT_FALSE(run.at("failures").empty());
  const std::string said = content(folder / "said");
  const std::size_t begin = said.find("./s4tp run ");
  ASSERT_NE(begin, std::string::npos);
  const std::string options = said.substr(begin + 7, said.find('\n', begin) - begin - 7);
  const std::string tool = fs::path(S4TP_BINARY_DIR) / "sim_host" / "s4tp_tool";
  const std::string command = tool + " " + options + " --out " + (folder / "again").string();
  EXPECT_EQ(WEXITSTATUS(std::system((command + " >" + (folder / "said").string()).c_str())), 1);
  const nlohmann::json again = nlohmann::json::parse(content(folder / "again" / "run.json"));
  EXPECT_EQ(again.at("runs").at(0).at("failures").at(0), run.at("failures").at(0));
}

// Two results compared by cell and seed: bare against guarded cannot be paired, a planner with another can.
TEST(Campaign, ComparesOnTheSameEpisodes) {
  const fs::path folder = scratch();
  ASSERT_EQ(eval(campaign(folder / "out"), folder / "said"), 0);
  const std::string json = folder / "out" / "results.json";
  EXPECT_EQ(eval({"compare", json, json}, folder / "said"), 0);
  EXPECT_NE(content(folder / "said").find("blind, bare, all scenarios"), std::string::npos);
  EXPECT_EQ(eval({"compare", json, "--planner", "blind", "--against", "constant_speed"}, folder / "said"), 0);
  EXPECT_EQ(eval({"compare", json}, folder / "said"), 2);
  EXPECT_EQ(eval({"compare", json, "--against", "nobody"}, folder / "said"), 2);
}

// Roads by number: drawn into the output folder, driven, put together by family; the numbers are the same
// when the same roads are named by their folder.
TEST(Campaign, RoadsByFamily) {
  const fs::path folder = scratch();
  const std::vector<std::string> plan{"--planner", "constant_speed", "--guard", "on,off", "--episodes", "2"};
  const auto with = [&](const std::string& roads, const std::string& out) {
    std::vector<std::string> words = plan;
    for (const std::string& word :
         {std::string("--roads"), roads, std::string("--out"), (folder / out).string()}) {
      words.push_back(word);
    }
    return words;
  };
  ASSERT_EQ(eval(with("11:15", "drawn"), folder / "said"), 0);
  const auto numbers = nlohmann::json::parse(content(folder / "drawn" / "results.json"));
  std::map<std::string, int> roads;
  for (const auto& family : numbers.at("families"))
    roads[family.at("family")] += family.at("roads").get<int>();
  EXPECT_EQ(roads.size(), 15U);      // 14 families and all roads
  EXPECT_EQ(roads.at("cruise"), 4);  // roads 11 and 25, guarded and bare
  EXPECT_EQ(roads.at("all roads"), 30);
  EXPECT_FALSE(numbers.at("family_pairs").empty());
  ASSERT_EQ(eval(with((folder / "drawn" / "roads").string(), "named"), folder / "said"), 0);
  const auto named = nlohmann::json::parse(content(folder / "named" / "results.json"));
  EXPECT_EQ(named.at("families"), numbers.at("families"));
  EXPECT_EQ(named.at("runs"), numbers.at("runs"));
  EXPECT_EQ(eval(with("11", "no"), folder / "said"), 2);
  EXPECT_EQ(eval(with((folder / "nothing").string(), "no"), folder / "said"), 2);
}

// More parts than episodes: the last one has none, and is done.
TEST(Campaign, APartMayBeEmpty) {
  const fs::path folder = scratch();
  ASSERT_EQ(eval(campaign(folder / "out", {"--shard", "999/999"}), folder / "said"), 0);
  EXPECT_NE(content(folder / "said").find("part 999/999: 0 episodes"), std::string::npos);
}

// Wrong use is code 2, with what is accepted.
TEST(Campaign, WrongUse) {
  const fs::path folder = scratch();
  EXPECT_EQ(eval({"--planner", "autopilot"}, folder / "said"), 2);
  EXPECT_EQ(eval(campaign(folder / "out", {"--shard", "4/3"}), folder / "said"), 2);
  EXPECT_NE(content(folder / "said").find("i from 1 to n"), std::string::npos);
  EXPECT_EQ(eval({"--scenarios", folder / "nowhere", "--out", folder / "out"}, folder / "said"), 2);
  EXPECT_EQ(eval({"merge", folder / "nowhere", "--json", folder / "x.json"}, folder / "said"), 2);
}

// A value named twice counted its episodes twice, as if there were twice as many.
TEST(Campaign, NothingCountsTwice) {
  const fs::path folder = scratch();
  const std::pair<std::string, std::string> named[] = {{"--planner", "constant_speed"},
                                                       {"--scenario", "cruise"},
                                                       {"--flavour", "smarts"},
                                                       {"--traffic", "builtin"},
                                                       {"--guard", "on"}};
  for (const auto& [option, value] : named) {
    EXPECT_EQ(
        eval({option, value, option, value, "--episodes", "1", "--out", folder / "out"}, folder / "said"), 2)
        << option;
    EXPECT_NE(content(folder / "said").find("asked for twice"), std::string::npos)
        << content(folder / "said");
  }
}

// FILE-009 A seed below zero was 2^64 - 1 and more; beyond what a seed can be it was another one.
TEST(Campaign, SeedsAreWrittenInDigits) {
  const fs::path folder = scratch();
  for (const std::string seed : {"-1", "1e3", "18446744073709551615", "", "+1"}) {
    EXPECT_EQ(eval(campaign(folder / "out", {"--seed", seed}), folder / "said"), 2) << seed;
    EXPECT_NE(content(folder / "said").find("accepted is a whole number"), std::string::npos)
        << content(folder / "said");
  }
  EXPECT_EQ(eval(campaign(folder / "out", {"--episodes", "1000000000000"}), folder / "said"), 2);
}

// `merge` is a scenario after --scenario, and a subcommand after eval.
TEST(Campaign, AScenarioMayHaveASubcommandsName) {
  const fs::path folder = scratch();
  ASSERT_EQ(eval({"--planner", "constant_speed", "--guard", "off", "--episodes", "1", "--scenario",
                  "overtake", "merge", "--out", folder / "out"},
                 folder / "said"),
            0)
      << content(folder / "said");
  const auto numbers = nlohmann::json::parse(content(folder / "out" / "results.json"));
  ASSERT_EQ(numbers.at("runs").size(), 2U);
  EXPECT_EQ(numbers.at("runs").at(1).at("scenario"), "merge");
}

// FILE-010 A second run without --out, and a third at the same time, leave the first one's result alone and
// say where theirs is.
TEST(Campaign, DefaultFoldersAreNotOverwritten) {
  const fs::path folder = scratch();
  const std::string tool = fs::path(S4TP_BINARY_DIR) / "sim_host" / "s4tp_tool";
  const auto run = [&](const std::string& seed) {
    return "cd " + folder.string() + " && " + tool +
           " run --scenario overtake --planner constant_speed --seed " + seed + " >said" + seed + " 2>&1";
  };
  (void)std::system(run("3").c_str());
  const std::string first = content(folder / "out" / "run" / "run.json");
  ASSERT_FALSE(first.empty()) << content(folder / "said3");
  (void)std::system(("(" + run("4") + ") & (" + run("5") + ") & wait").c_str());
  EXPECT_EQ(content(folder / "out" / "run" / "run.json"), first);
  std::vector<int> seeds;
  for (const char* const name : {"run-2", "run-3"}) {
    seeds.push_back(nlohmann::json::parse(content(folder / "out" / name / "run.json"))
                        .at("episode")
                        .at("seed")
                        .get<int>());
  }
  std::sort(seeds.begin(), seeds.end());
  EXPECT_EQ(seeds, (std::vector<int>{4, 5}));
  EXPECT_NE(content(folder / "said4").find("holds a result already"), std::string::npos)
      << content(folder / "said4");
}

}  // namespace
}  // namespace s4tp
