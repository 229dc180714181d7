// A cut ([cut] of a scenario.toml, and the log of its commands): refused with a reason, or whole; what was read is written
// and read again the same. The log is what stands behind the first line "---".

#include <cstring>
#include <fstream>
#include <iterator>

#include "sim_host/world/scenario/cut.hpp"
#include "sim_host/world/scenario/scenario.hpp"
#include "tests/fuzz/files.hpp"

using namespace s4tp;
using namespace s4tp::scenario;
using fuzz::expect;

namespace {

constexpr const char* kBetween = "---\n";

std::string read(const std::string& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// The folder with the scenario that was driven.
const test::Folder& folder() {
  static const bool filled = [] {
    for (const char* file : {"zipper.net.xml", "zipper.rou.xml"})
      fuzz::folder().write(file, read(std::string(S4TP_SOURCE_DIR "/tests/networks/") + file));
    fuzz::folder().write("of.toml", read(S4TP_SOURCE_DIR "/tests/networks/zipper.toml"));
    return true;
  }();
  expect(filled, "the folder is there");
  return fuzz::folder();
}

bool same(const Cut& a, const Cut& b) {
  if (a.flavour != b.flavour || a.seed != b.seed || a.traffic != b.traffic || a.perception != b.perception ||
      a.start_tick != b.start_tick || a.commands.size() != b.commands.size())
    return false;
  for (std::size_t tick = 0; tick < a.commands.size(); ++tick) {
    if (a.commands[tick].size() != b.commands[tick].size()) return false;
    for (std::size_t i = 0; i < a.commands[tick].size(); ++i) {
      const wire::Frame& one = a.commands[tick][i];
      const wire::Frame& other = b.commands[tick][i];
      if (one.id != other.id || one.length != other.length ||
          std::memcmp(one.data, other.data, one.length) != 0)
        return false;
    }
  }
  return true;
}

void check(const Cut& cut) {
  expect(cut.start_tick >= 0 && cut.start_tick <= 1'000'000, "the start is in its range");
  expect(cut.commands.size() == static_cast<std::size_t>(cut.start_tick), "a row for each tick before");
  for (const auto& tick : cut.commands) {
    for (const wire::Frame& frame : tick) expect(frame.length <= 8, "frames are the wire's");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  const std::size_t between = text.find(kBetween);
  const auto file = folder().write("fuzz.toml", text.substr(0, between));
  fuzz::folder().write("fuzz.log",
                       between == std::string::npos ? "" : text.substr(between + std::strlen(kBetween)));
  static_cast<void>(fuzz::accepts("/", [&] {  // of the folder, or whatever else the cut names
    const Scenario scenario = load_scenario(file);
    if (!scenario.cut) return;
    check(*scenario.cut);
    expect(!scenario.network.lanes.empty(), "the scenario driven is whole");
    if (scenario.cut->of.lexically_normal() != fuzz::folder().path() / "of.toml") return;
    write_cut(*scenario.cut, "again", fuzz::folder().path());
    const Scenario again = load_scenario(fuzz::folder().path() / "scenario.toml");
    expect(again.cut && same(*scenario.cut, *again.cut), "what was read is written and read again the same");
  }));
  return 0;
}
