#include "sim_host/commands/slips.hpp"

#include <algorithm>
#include <cstddef>

namespace s4tp::commands {
namespace {

/// Letters changed, left out, added, or two exchanged, between two words (Damerau and Levenshtein).
std::size_t distance(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> steps(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        steps[i][j] = i + j;
        continue;
      }
      const std::size_t changed = steps[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      steps[i][j] = std::min({changed, steps[i - 1][j] + 1, steps[i][j - 1] + 1});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        steps[i][j] = std::min(steps[i][j], steps[i - 2][j - 2] + 1);
      }
    }
  }
  return steps[a.size()][b.size()];
}

std::string remedy(const std::string& word, const std::vector<std::string>& known) {
  const std::string meant = nearest(word, known);
  return meant.empty() ? "; --help lists them" : "; did you mean " + meant + "?";
}

std::vector<std::string> commands_of(const CLI::App& tool) {
  std::vector<std::string> names;
  for (const CLI::App* command : tool.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

/// The command in which a word was not understood, at whatever depth.
const CLI::App& deepest(const CLI::App& tool) {
  const std::vector<CLI::App*> parsed = tool.get_subcommands();
  return parsed.empty() ? tool : deepest(*parsed.front());
}

}  // namespace

std::string first_steps() {
  return R"(s4tp: planner firmware for cars. To begin with:

  s4tp demo                                 four scenarios over CAN, a table, pages to look at (minutes)
  s4tp run --scenario left_turn --seed 3    one drive: picture, replay in the browser, reasons of every plan

s4tp --help lists all commands, each has a --help of its own; man s4tp has them all.
)";
}

std::string nearest(const std::string& word, const std::vector<std::string>& known) {
  std::string best;
  std::size_t least = std::min<std::size_t>(2, word.size() / 3) + 1;
  for (const std::string& name : known) {
    const std::size_t between = distance(word, name);
    if (between < least) {
      least = between;
      best = name;
    }
  }
  return best;
}

std::string wrong_command(const CLI::App& tool, const std::string& word) {
  const std::vector<std::string> known = commands_of(tool);
  if (word.starts_with('-') || std::find(known.begin(), known.end(), word) != known.end()) return {};
  return "there is no command '" + word + "'" + remedy(word, known);
}

std::string wrong_arguments(const CLI::App& tool) {
  const CLI::App& command = deepest(tool);
  std::vector<std::string> options;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) options.push_back("--" + name);
  }
  const std::vector<std::string> unknown = tool.remaining(true);
  const std::string word = unknown.front().substr(0, unknown.front().find('='));
  const std::string kind = word.starts_with('-') ? "has no option " : "does not know what to do with ";
  return command.get_name() + " " + kind + word + remedy(word, options);
}

}  // namespace s4tp::commands
