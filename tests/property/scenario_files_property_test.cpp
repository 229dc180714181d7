// Files from outside, damaged: a clear error or a scenario that drives, never anything else.

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim_host/world/nodes/map_node.hpp"
#include "sim_host/world/world.hpp"
#include "tests/support/networks.hpp"

namespace s4tp::scenario {
namespace {

using test::Folder;

std::string read(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// A few pieces cut out, doubled, or overwritten by what often breaks a reader.
std::string damaged(std::string text) {
  static const std::vector<std::string> kBreakers = {
      "",  "0", "-1", "1e308", "nan",  "\"", "<",   ">",  "/",  " ", "=",          "[",
      "]", ",", "_0", ":",     "&#0;", "-0", "1e9", "\n", "{}", "é", "99999999999"};
  const int wounds = *rc::gen::inRange(1, 4);
  for (int i = 0; i < wounds && !text.empty(); ++i) {
    const auto at = *rc::gen::inRange<std::size_t>(0, text.size());
    const auto length = *rc::gen::inRange<std::size_t>(0, 12);
    switch (*rc::gen::inRange(0, 3)) {
      case 0:
        text.replace(at, length, *rc::gen::elementOf(kBreakers));
        break;
      case 1:
        text.insert(at, text.substr(at, length * 8));
        break;
      default: {  // a number or name becomes another of the same file
        const auto from = *rc::gen::inRange<std::size_t>(0, text.size());
        text.replace(at, length, text.substr(from, length));
      }
    }
  }
  return text;
}

/// Loads, and where that works drives for 2 s.
void load_and_drive(const Folder& folder) {
  try {
    const Scenario scenario = load_scenario(folder.path());
    world::WorldOptions options;
    options.pre_roll_s = 0.5;
    world::World world(scenario, options);
    std::vector<wire::Frame> frames;
    for (int tick = 0; tick < 200 && !world.finished(); ++tick) {
      frames.clear();
      world.tick(frames);
    }
    RC_ASSERT(!frames.empty());
  } catch (const std::runtime_error& error) {
    const std::string what = error.what();
    RC_ASSERT(what.find(folder.path().string()) != std::string::npos);  // it names the file
    RC_ASSERT(what.size() > folder.path().string().size() + 10);        // and what is wrong
  }
}

void check(const std::string& name, const std::string& wounded) {
  const std::filesystem::path source = std::filesystem::path(S4TP_SOURCE_DIR) / "tests" / "networks";
  std::string toml = read(source / (name + ".toml"));
  toml = test::replaced(toml, "entry_time_s = 20.0", "entry_time_s = 2.0");
  EXPECT_TRUE(rc::check(wounded + " of " + name, [&] {
    const Folder folder;
    folder.write("scenario.toml", wounded == "toml" ? damaged(toml) : toml);
    for (const char* kind : {"net", "rou"}) {
      const std::string file = name + "." + kind + ".xml";
      const std::string text = read(source / file);
      folder.write(file, wounded == kind ? damaged(text) : text);
    }
    load_and_drive(folder);
  }));
}

// SCN-001 A damaged scenario.toml.
TEST(ScenarioFiles, DamagedToml) {
  check("tee", "toml");
}

// NET-001 A damaged network.
TEST(ScenarioFiles, DamagedNetwork) {
  check("zipper", "net");
  check("tee", "net");
  check("no_inner_lanes", "net");
}

// SCN-003 A damaged route file.
TEST(ScenarioFiles, DamagedRoutes) {
  check("tee", "rou");
}

}  // namespace
}  // namespace s4tp::scenario
