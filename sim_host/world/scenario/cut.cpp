#include "sim_host/world/scenario/cut.hpp"

#include <fstream>
#include <stdexcept>

#include "firmware/wire/candump.hpp"
#include "sim_host/world/scenario/engine.hpp"
#include "sim_host/world/scenario/listed.hpp"
#include "sim_host/world/scenario/perception_preset.hpp"
#include "sim_host/world/scenario/toml_table.hpp"

namespace s4tp::scenario {
namespace {

constexpr int kTicksMax = 1'000'000;  // beyond the longest pre-roll and time limit
constexpr std::uint64_t kTick_us = 10'000;
constexpr const char* kCommandsFile = "commands.log";

std::vector<std::vector<wire::Frame>> read_commands(const std::filesystem::path& file, int ticks) {
  std::vector<std::vector<wire::Frame>> commands(static_cast<std::size_t>(ticks));
  std::ifstream stream(file);
  if (!stream) throw std::runtime_error(file.string() + ": cannot be read");
  int number = 0;
  for (std::string line; std::getline(stream, line);) {
    ++number;
    wire::LoggedFrame logged;
    const wire::CandumpResult result =
        wire::parse_candump(line.data(), static_cast<int>(line.size()), logged);
    if (result == wire::CandumpResult::kSkipped) continue;
    const std::uint64_t tick = logged.time_us / kTick_us;
    if (result == wire::CandumpResult::kMalformed || tick >= commands.size()) {
      throw std::runtime_error(file.string() + ":" + std::to_string(number) +
                               ": expected a frame as candump writes it, before start_tick");
    }
    commands[tick].push_back(logged.frame);
  }
  return commands;
}

std::string one_of(TomlTable& table, const std::string& key, const std::vector<std::string>& names) {
  const std::string name = table.text(key);
  if (std::find(names.begin(), names.end(), name) != names.end()) return name;
  table.fail(key, "expected one of " + listed(names));
}

std::uint64_t seed_of(TomlTable& table) {
  const toml::value& seed = table.require("seed");
  if (!seed.is_integer() || seed.as_integer() < 0) table.fail("seed", "expected a whole number");
  return static_cast<std::uint64_t>(seed.as_integer());
}

}  // namespace

Cut read_cut(TomlTable table, const std::filesystem::path& file) {
  const std::filesystem::path folder = file.parent_path();
  Cut cut;
  cut.of = folder / table.text("of");
  if (!std::filesystem::exists(cut.of)) table.fail("of", cut.of.string() + ": there is no such scenario");
  cut.flavour = table.text("flavour", "");
  cut.seed = seed_of(table);
  cut.traffic = one_of(table, "traffic", engine_names());
  cut.perception = one_of(table, "perception", perception_names());
  static_cast<void>(table.require("start_tick"));
  cut.start_tick = table.integer("start_tick", 0, 0, kTicksMax);
  cut.commands_file = folder / table.text("commands");
  if (!std::filesystem::is_regular_file(cut.commands_file)) {  // of a device there may be no end
    table.fail("commands", cut.commands_file.string() + ": there is no such file");
  }
  table.no_other_keys();
  cut.commands = read_commands(cut.commands_file, cut.start_tick);
  return cut;
}

void write_cut(const Cut& cut, const std::string& heading, const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "scenario.toml";
  const std::filesystem::path log = folder / kCommandsFile;
  std::ofstream commands(log);
  for (std::size_t tick = 0; tick < cut.commands.size(); ++tick) {
    for (const wire::Frame& frame : cut.commands[tick]) {
      char line[wire::kCandumpLineSize];
      wire::format_candump({tick * kTick_us, "vcan0", frame}, line);
      commands << line << '\n';
    }
  }
  commands.close();
  if (!commands) throw std::runtime_error(log.string() + ": cannot be written");
  const auto quoted = [](const std::string& text) { return toml::format(toml::value(text), 0); };
  std::ofstream stream(file);
  stream << "# " << heading << "\n[cut]\nof = " << quoted(cut.of.lexically_relative(folder).string())
         << "\nflavour = " << quoted(cut.flavour) << "\nseed = " << cut.seed << "\ntraffic = \""
         << cut.traffic << "\"\nperception = \"" << cut.perception << "\"\nstart_tick = " << cut.start_tick
         << "\ncommands = \"" << kCommandsFile << "\"\n";
  stream.close();
  if (!stream) throw std::runtime_error(file.string() + ": cannot be written");
}

}  // namespace s4tp::scenario
