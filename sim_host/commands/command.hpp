#pragma once
/// The commands of the host tool: one file each, which adds its options and says what it does with them.
/// Exit codes: 0 done, 1 the result is not good enough or an episode failed, 2 wrong use or broken input,
/// 130 stopped by a signal.

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "algo/core/parameters.hpp"
#include "sim_host/processes/own_files.hpp"
#include "sim_host/processes/own_folder.hpp"
#include "sim_host/world/scenario/scenario.hpp"

namespace s4tp::commands {

inline constexpr int kDone = 0;
inline constexpr int kNotGoodEnough = 1;
inline constexpr int kWrongUse = 2;
inline constexpr int kInterrupted = 130;

struct Command {
  CLI::App* app = nullptr;
  std::function<int()> run;  ///< \return exit code \throws std::exception: wrong use or broken input
};

[[nodiscard]] Command add_demo(CLI::App& tool);
[[nodiscard]] Command add_eval(CLI::App& tool);
/// A subcommand of eval.
[[nodiscard]] Command add_eval_report(CLI::App& eval);
[[nodiscard]] Command add_run(CLI::App& tool);
[[nodiscard]] Command add_record(CLI::App& tool);
[[nodiscard]] Command add_replay(CLI::App& tool);
[[nodiscard]] Command add_traffic(CLI::App& tool);
[[nodiscard]] Command add_coupling(CLI::App& tool);
[[nodiscard]] Command add_faults(CLI::App& tool);
[[nodiscard]] Command add_risk(CLI::App& tool);
[[nodiscard]] Command add_roads(CLI::App& tool);
[[nodiscard]] Command add_train(CLI::App& tool);
[[nodiscard]] Command add_predict(CLI::App& tool);
[[nodiscard]] Command add_telemetry(CLI::App& tool);
[[nodiscard]] Command add_view(CLI::App& tool);

/// What `--roads` names: the scenario folders in a folder, by name; or, as "N:K", roads N to N + K - 1, drawn
/// into `out`. \throws std::invalid_argument when it is neither, std::runtime_error as roads::write_road()
[[nodiscard]] std::vector<std::string> road_folders(const std::string& text,
                                                    const std::filesystem::path& scenario_root,
                                                    const std::filesystem::path& out);

/// FILE-009 A seed is written in digits: CLI11 alone would take -1 for 2^64 - 1. Also the limit of episodes.
extern const CLI::Validator kSeed;
extern const CLI::Validator kEpisodes;

using processes::OwnFolder;

/// `eval --scenario left_turn merge` names two scenarios, one of which has a subcommand's name: the names
/// that follow a list's option become one argument, joined with commas. \param arguments  as main() has them,
/// without the program
[[nodiscard]] std::vector<std::string> with_lists_joined(const std::vector<std::string>& arguments);

/// The first drive that a newcomer sees is one that reaches its goal: `run` and `demo` begin with it.
inline constexpr std::uint64_t kFirstDriveSeed = 1;

/// Options that commands share, with the same words and meaning everywhere.
struct CommonOptions {
  std::filesystem::path scenario_root = processes::own_data("scenarios");
  std::string flavour = "smarts";
  std::string parameters_file;
  std::filesystem::path out;
  const CLI::Option* out_named = nullptr;
  std::uint64_t seed = 0;
  std::string traffic = "builtin";

  void add_to(CLI::App& command);
  void add_traffic_to(CLI::App& command);
  [[nodiscard]] Parameters parameters() const;
  /// Where nobody named --out, a folder of this command's own. \throws std::runtime_error
  [[nodiscard]] OwnFolder choose_out();
  /// A scenario by the name of a shipped one, by its folder or its .toml file; in the flavour asked for.
  [[nodiscard]] scenario::Scenario find_scenario(const std::string& name) const;
};

}  // namespace s4tp::commands
