#include "sim_host/processes/board_console.hpp"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

namespace s4tp::processes {
namespace {

constexpr const char* kPreemptions = "preemptions";
constexpr const char* kControl = "control";
constexpr const char* kAll = "all";

struct Row {
  std::string name;
  std::size_t cycles = 0;
  double median = 0.0;
  double maximum = 0.0;
};

Row row_of(const std::string& name, const BoardConsole& console) {
  std::vector<double> values;
  for (const CycleCost& cycle : console.cycles) {
    if (const double value = cycle.at(name); value > 0.0) values.push_back(value);
  }
  Row row{name, values.size()};
  if (values.empty()) return row;
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  row.median = values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2.0;
  row.maximum = values.back();
  return row;
}

std::vector<Row> rows_of(const BoardConsole& console) {
  std::vector<Row> rows;
  if (console.cycles.empty()) return rows;
  for (const std::string& stage : console.stages) rows.push_back(row_of(stage, console));
  for (const char* name : {kAll, kControl}) rows.push_back(row_of(name, console));
  return rows;
}

/// \return whether the line is whole
bool read_cycle(std::istream& words, double counts_per_instruction, BoardConsole& console) {
  CycleCost cycle;
  std::vector<std::string> stages;
  double all = 0.0;
  double number = 0.0;
  for (std::string name; words >> name >> number;) {
    if (name == kPreemptions) {
      cycle[name] = number;
      continue;
    }
    cycle[name] = number / counts_per_instruction / 1e6;
    if (name == kControl) continue;
    stages.push_back(name);
    all += cycle[name];
  }
  if (cycle.count(kPreemptions) == 0 || cycle.count(kControl) == 0) return false;
  if (!console.cycles.empty() && stages != console.stages) return false;
  cycle[kAll] = all;
  console.stages = stages;
  console.cycles.push_back(cycle);
  return true;
}

}  // namespace

BoardConsole read_console(std::istream& text, double counts_per_instruction) {
  BoardConsole console;
  for (std::string line; std::getline(text, line);) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "cycle" && read_cycle(words, counts_per_instruction, console)) continue;
    if (kind == "tick") {
      for (std::string word; words >> word;) {
        int bytes = 0;
        if (word == "stack" && words >> bytes) console.stack_bytes = std::max(console.stack_bytes, bytes);
      }
      continue;
    }
    if (!line.empty()) console.others.push_back(line);
  }
  return console;
}

std::map<std::string, double> load_budget(const std::filesystem::path& file) {
  std::ifstream text(file);
  if (!text) throw std::runtime_error(file.string() + ": cannot be read");
  return nlohmann::json::parse(text).at("million_instructions").get<std::map<std::string, double>>();
}

void print_costs(std::ostream& out, const BoardConsole& console,
                 const std::map<std::string, double>& budget) {
  char text[100];
  std::snprintf(text, sizeof text, "%-14s%8s%10s%10s%10s\n", "M instructions", "cycles", "median", "max",
                "budget");
  out << text;
  for (const Row& row : rows_of(console)) {
    std::snprintf(text, sizeof text, "%-14s%8zu%10.3f%10.3f", row.name.c_str(), row.cycles, row.median,
                  row.maximum);
    out << text;
    if (const auto limit = budget.find(row.name); limit != budget.end()) {
      std::snprintf(text, sizeof text, "%10.1f%s", limit->second,
                    row.maximum > limit->second ? "  OVER" : "");
      out << text;
    }
    out << '\n';
  }
  double preemptions = 0.0;
  for (const CycleCost& cycle : console.cycles) preemptions += cycle.at(kPreemptions);
  out << "control interrupted planning " << preemptions << " times in " << console.cycles.size()
      << " cycles; stack " << console.stack_bytes << " bytes\n";
}

void write_costs(const std::filesystem::path& file, const std::string& target, const BoardConsole& console,
                 const std::map<std::string, double>& budget) {
  nlohmann::ordered_json json;
  json["target"] = target;
  json["unit"] = "million instructions, counted by QEMU";
  json["stack_bytes"] = console.stack_bytes;
  for (const Row& row : rows_of(console)) {
    nlohmann::ordered_json one{{"cycles", row.cycles}, {"median", row.median}, {"max", row.maximum}};
    if (const auto limit = budget.find(row.name); limit != budget.end()) one["budget"] = limit->second;
    json["stages"][row.name] = one;
  }
  json["cycles"] = console.cycles;
  std::ofstream out(file);
  out << json.dump(1) << '\n';
  if (!out) throw std::runtime_error(file.string() + ": cannot be written");
}

}  // namespace s4tp::processes
