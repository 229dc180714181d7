#include "sim_host/campaign/cell.hpp"

#include <algorithm>
#include <cctype>

namespace s4tp::campaign {
namespace {

/// As a shell takes it back.
std::string quoted(const std::string& word) {
  const bool plain = !word.empty() && std::all_of(word.begin(), word.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || std::string("_-./+:").find(static_cast<char>(c)) != std::string::npos;
  });
  if (plain) return word;
  std::string result = "'";
  for (const char c : word) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

}  // namespace

std::string words(const Cell& cell) {
  std::string text = cell.planner + (cell.guarded ? "" : ", bare") + ", " + cell.scenario;
  if (cell.flavour != Cell{}.flavour) text += ", " + cell.flavour;
  if (cell.traffic != Cell{}.traffic) text += ", " + cell.traffic + " traffic";
  if (cell.perception != Cell{}.perception) text += ", " + cell.perception + " perception";
  return text;
}

std::string replay_command(const Cell& cell, const std::string& scenario_argument,
                           const std::string& parameters_file, std::uint64_t seed) {
  std::string command = "./s4tp run --scenario " + quoted(scenario_argument) + " --seed " +
                        std::to_string(seed) + " --planner " + cell.planner;
  const Cell usual;
  if (cell.guarded != usual.guarded) command += " --guard off";
  if (cell.flavour != usual.flavour) command += " --flavour " + quoted(cell.flavour);
  if (cell.traffic != usual.traffic) command += " --traffic " + cell.traffic;
  if (cell.perception != usual.perception) command += " --perception " + cell.perception;
  if (!parameters_file.empty()) command += " --parameters " + quoted(parameters_file);
  return command;
}

}  // namespace s4tp::campaign
