#pragma once
/// What an ECU image tells on its console: the cost of each planning cycle, and its last words.

#include <filesystem>
#include <istream>
#include <map>
#include <ostream>
#include <string>
#include <vector>

namespace s4tp::processes {

/// One planning cycle, name -> number, in the image's order of names.
using CycleCost = std::map<std::string, double>;

struct BoardConsole {
  std::vector<std::string> stages;  ///< in the order of the cycle
  std::vector<CycleCost> cycles;    ///< million instructions by stage, and "control": of a control tick;
                                    ///< "preemptions": control ticks that interrupted it
  int stack_bytes = 0;              ///< highest use
  std::vector<std::string> others;  ///< lines of any other kind
};

/// PROC-041 Reads the console, cut off anywhere. \param counts_per_instruction  of the board's counter
[[nodiscard]] BoardConsole read_console(std::istream& console, double counts_per_instruction);

/// The budget by stage, docs/budget.md [million instructions], "all" for all together.
[[nodiscard]] std::map<std::string, double> load_budget(const std::filesystem::path& file);

/// PROC-042 The table of stages: median, maximum, budget. A stage counts in the cycles it ran in.
void print_costs(std::ostream& out, const BoardConsole& console, const std::map<std::string, double>& budget);
/// PROC-043 The same and every cycle, as JSON. \throws std::runtime_error when it cannot be written
void write_costs(const std::filesystem::path& file, const std::string& target, const BoardConsole& console,
                 const std::map<std::string, double>& budget);

}  // namespace s4tp::processes
