// TOML: a scenario.toml beside a network and routes, then as a file of parameters. Refused with a reason, or whole.

#include <cmath>
#include <fstream>
#include <iterator>

#include "sim_host/campaign/parameters_file.hpp"
#include "sim_host/world/scenario/scenario.hpp"
#include "tests/fuzz/files.hpp"

using namespace s4tp;
using namespace s4tp::scenario;
using fuzz::expect;

namespace {

std::string read(const std::string& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// The folder with what a scenario may name.
const test::Folder& folder() {
  static const bool filled = [] {
    for (const char* file : {"zipper.net.xml", "zipper.rou.xml"}) {
      fuzz::folder().write(file, read(std::string(S4TP_SOURCE_DIR "/tests/networks/") + file));
    }
    // a road on which a goal can be too far away
    fuzz::folder().write("long.net.xml", test::replaced(test::kCross, "10,0 50,0", "10,0 5000,0"));
    fuzz::folder().write("mix.toml", "[[mix]]\nname = \"calm\"\nheadway_s = 2.0\n");
    return true;
  }();
  expect(filled, "the folder is there");
  return fuzz::folder();
}

bool within(double value, double low, double high) {
  return value >= low && value <= high;
}

void check(const Scenario& scenario) {
  const Mission& mission = scenario.mission;
  const auto count = static_cast<map::LaneId>(scenario.network.lanes.size());
  expect(mission.start_lane >= 0 && mission.start_lane < count && mission.goal_lane >= 0 &&
             mission.goal_lane < count,
         "start and goal are lanes");
  const auto length_m = [&](map::LaneId lane) {
    return scenario.network.lanes[static_cast<std::size_t>(lane)].centre.length_m();
  };
  expect(within(mission.start_s_m, 0.0, length_m(mission.start_lane)), "the start is on its lane");
  expect(within(mission.goal_s_m, 0.0, length_m(mission.goal_lane)), "the goal is on its lane");
  expect(within(mission.entry_time_s, 0.0, 600.0) && within(mission.time_limit_s, 1.0, 3600.0) &&
             within(mission.start_speed_mps, 0.0, 100.0),
         "times and speed are in their ranges");
  static_cast<void>(mission_guide(scenario));
  for (const FlowGroup& group : scenario.flows) {
    expect(!group.routes.empty() && !group.drivers.empty() && group.choose_low <= group.choose_high,
           "a flow is whole");
    expect(group.choose_low >= 0 && group.choose_high <= static_cast<int>(group.routes.size()),
           "of routes there are");
    for (const DriverModel& driver : group.drivers) {
      expect(within(driver.headway_s, 0.1, 10.0) && within(driver.weight, 0.001, 1000.0),
             "drivers are in their ranges");
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  const auto file = folder().write("fuzz.toml", text);
  for (const char* flavour : {"", "other"}) {
    if (*flavour != '\0' && text.find(flavour) == std::string::npos) continue;
    static_cast<void>(
        fuzz::accepts(fuzz::folder().path().string(), [&] { check(load_scenario(file, flavour)); }));
  }
  static_cast<void>(fuzz::accepts("fuzz.toml", [&] {
    int bad = 0;
    expect(validate(campaign::load_parameters(file), bad) == Status::kOk, "parameters are in their ranges");
  }));
  return 0;
}
