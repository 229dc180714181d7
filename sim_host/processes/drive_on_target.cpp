#include "sim_host/processes/drive_on_target.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <stdexcept>

#include "sim_host/campaign/weights_file.hpp"
#include "sim_host/processes/board_console.hpp"
#include "sim_host/processes/board_twin.hpp"
#include "sim_host/processes/drive_on_bus.hpp"
#include "sim_host/processes/emulated_board.hpp"
#include "sim_host/processes/own_files.hpp"

namespace s4tp::processes {
namespace {

namespace fs = std::filesystem;

// An emulated processor on a busy machine takes its time; one that has stopped is seen at once.
constexpr int kAnswerWithin_ms = 20'000;
constexpr int kDeadAfter_ms = 30'000;
constexpr const char* kProgram = "qemu-system-arm";

void look_for_qemu() {
  std::string path = std::getenv("PATH") != nullptr ? std::getenv("PATH") : "";
  for (std::size_t begin = 0; begin <= path.size();) {
    const std::size_t end = std::min(path.find(':', begin), path.size());
    if (fs::exists(fs::path(path.substr(begin, end - begin)) / kProgram)) return;
    begin = end + 1;
  }
  throw std::runtime_error(std::string(kProgram) + " is not installed: apt-get install " + kProgram);
}

/// Where a source tree builds it.
fs::path built_image(const std::string& target) {
  const fs::path source = has_own_data("source") ? own_data("source") : fs::path();
  return source / "build" / target / "firmware" / "targets" / "ecu_lockstep";
}

}  // namespace

int drive_on_target(const scenario::Scenario& scenario, const TargetOptions& options, std::ostream& out) {
  const EmulatedBoard& board = find_board(options.target);
  const fs::path image = options.image.empty() ? built_image(options.target) : options.image;
  if (!fs::exists(image)) {
    throw std::runtime_error(image.string() + ": no such image; in the source tree: cmake --preset " +
                             options.target + " && cmake --build --preset " + options.target +
                             " --target ecu_lockstep");
  }
  look_for_qemu();
  fs::create_directories(options.out);
  const fs::path console_file = options.out / ("console_" + options.target + ".txt");
  const std::uint16_t port = free_loopback_port();

  DriveOptions drive;
  drive.world = options.world;
  drive.world.bus = "slcan:listen:127.0.0.1:" + std::to_string(port);
  drive.world.answer_within_ms = kAnswerWithin_ms;
  drive.world.dead_after_ms = kDeadAfter_ms;
  const auto bank = options.weights.empty() ? nullptr : campaign::bank_with(options.weights);
  TwinOf twin_of{options.target};
  twin_of.weights = bank.get();
  BoardTwin twin(options.telemetry, twin_of, out);
  drive.world.record = [&](std::uint64_t time_us, const std::vector<wire::Frame>& frames) {
    if (options.world.record) options.world.record(time_us, frames);
    twin.hear(frames);
  };
  drive.planner = "s4tp on " + options.target;
  drive.out = options.out;
  drive.ecu_command = board_command(board, image, port, console_file, options.weights);
  const int code = drive_on_bus(scenario, drive, out);

  std::ifstream text(console_file);
  const BoardConsole console = read_console(text, board.counts_per_instruction);
  for (std::size_t i = 1; i < console.others.size(); ++i) {  // the first one says that it has started
    out << options.target << ": " << console.others[i] << '\n';
  }
  const auto budget = load_budget(own_data("budget.json"));
  print_costs(out, console, budget);
  const fs::path cost = options.out / ("cost_" + options.target + ".json");
  write_costs(cost, options.target, console, budget);
  out << "numbers: " << cost.string() << '\n';
  return code;
}

}  // namespace s4tp::processes
