#include "sim_host/processes/drive_on_bus.hpp"

#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "hal/linux/bus_name.hpp"
#include "sim_host/campaign/results.hpp"
#include "sim_host/metrics/metrics.hpp"
#include "sim_host/processes/bus_end.hpp"
#include "sim_host/processes/child_process.hpp"
#include "sim_host/processes/stop_signals.hpp"

namespace s4tp::processes {
namespace {

constexpr const char* kCaller = "slcan:tcp:";
constexpr int kStopped = 130;  // as every command that a signal ends
constexpr const char* kListener = "slcan:listen:";

/// What both processes say of their timing; an ECU we did not start keeps it to itself.
nlohmann::json timing_of(const WorldProcessResult& result, const std::filesystem::path& ecu_report) {
  nlohmann::json both;
  if (result.timing) both["world"] = to_json(*result.timing);
  if (std::ifstream file(ecu_report); file) {
    if (auto told = nlohmann::json::parse(file, nullptr, false); !told.is_discarded()) both["ecu"] = told;
  }
  if (!ecu_report.empty()) std::filesystem::remove(ecu_report);
  return {{"realtime", both}};
}

}  // namespace

std::string other_end(const std::string& bus) {
  const std::string listener = kListener;
  if (!bus.starts_with(listener)) return bus;
  const std::string place = bus.substr(listener.size());
  const std::string anyone = std::string(hal::linux_host::kAnyone) + ':';
  return kCaller + (place.starts_with(anyone) ? "127.0.0.1:" + place.substr(anyone.size()) : place);
}

bool has_two_ends(const std::string& bus) {
  return !bus.starts_with("slcan:") || bus.starts_with(kListener);
}

int drive_on_bus(const scenario::Scenario& scenario, const DriveOptions& options, std::ostream& out) {
  const std::atomic<bool>& stop = stop_on_signals();
  WorldProcessOptions world = options.world;
  const auto bus = std::make_unique<hal::linux_host::NamedBus>();
  open_bus(*bus, world.bus, Side::kWorld);
  const std::filesystem::path ecu_report = options.out / "ecu_realtime.json";
  std::optional<ChildProcess> ecu;
  if (!options.out.empty()) std::filesystem::create_directories(options.out);
  if (!options.ecu_command.empty()) {
    std::vector<std::string> command = options.ecu_command;
    if (world.realtime && !options.out.empty()) {
      std::filesystem::remove(ecu_report);
      command.insert(command.end(), {"--report", ecu_report});
    }
    ecu.emplace(command);
    world.ecu_lives = [&ecu] { return ecu->lives(); };
  }
  const WorldProcessResult result = run_world(scenario, bus->can(), world, out, stop);
  ecu.reset();  // it says its last words first
  if (!result.met_ecu) {
    out << "no ECU on " << world.bus << '\n';
    return 2;
  }
  campaign::EpisodeRow row;
  row.cell.planner = options.planner;
  row.cell.scenario = scenario.name;
  row.cell.traffic = scenario::engine_names().at(static_cast<std::size_t>(options.world.engine));
  row.metrics = metrics::evaluate(result.recording, scenario);
  print_link(out, world, result, bus->can());
  campaign::print_episode(out, row, result.recording);
  if (!options.out.empty()) {
    nlohmann::ordered_json document = campaign::results_json(row);
    if (result.timing) {
      document.update(
          nlohmann::ordered_json(timing_of(result, options.ecu_command.empty() ? "" : ecu_report)));
    }
    campaign::write_json(options.out / "run.json", document);
  }
  if (world.log) out << "bus log: " << world.log->string() << '\n';
  if (stop) return kStopped;
  return result.recording.ending == traffic::Ending::kGoal ? 0 : 1;
}

}  // namespace s4tp::processes
