// Texts that are handed to us; the first letter says which: k a key file, c a recorded clip, m a number that a fault script
// is made from, any other a fault script. Refused with a reason, or within the limits of its kind; a script is written and
// read again the same, a clip can be forecast.

#include <cctype>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <memory>
#include <vector>

#include "hal/linux/key_file.hpp"
#include "sim_host/clips/clip.hpp"
#include "sim_host/clips/forecaster.hpp"
#include "sim_host/clips/windows.hpp"
#include "sim_host/faults/script.hpp"
#include "tests/fuzz/files.hpp"

using namespace s4tp;
using fuzz::expect;

namespace {

constexpr std::size_t kKeyFileBytes = 254;  // with the white space around the key
constexpr std::size_t kWindows = 8;         // that are forecast

void check(const faults::FaultScript& script) {
  expect(!script.scenario.empty(), "a script names its scenario");
  for (const faults::Fault& fault : script.faults) {
    const faults::KindTraits& kind = faults::traits(fault.kind);
    expect((fault.messages & ~kind.messages) == 0, "a fault strikes what its kind may");
    expect(fault.intensity >= kind.intensity_min && fault.intensity <= kind.intensity_max,
           "an intensity is its kind's");
    expect(fault.from_tick >= -faults::kPreRollTicks && fault.from_tick <= faults::kRunTicks &&
               fault.ticks >= 1 && fault.ticks <= faults::kForGood,
           "a fault begins in the run");
  }
  const std::string text = faults::to_text(script);
  expect(faults::to_text(faults::parse_script(text, "again")) == text, "a script is read as it was written");
}

void take_script(const std::string& text) {
  static_cast<void>(fuzz::accepts("fuzz.txt", [&] { check(faults::parse_script(text, "fuzz.txt")); }));
}

/// The 32 digits, as the header describes a key's text; empty: there is no key in it.
std::string key_in(const std::string& text) {
  constexpr const char* kSpace = " \t\r\n";
  const std::size_t begin = text.find_first_not_of(kSpace);
  if (begin == std::string::npos || text.size() > kKeyFileBytes) return "";
  const std::string word = text.substr(begin, text.find_last_not_of(kSpace) + 1 - begin);
  for (const char c : word) {
    if (std::isxdigit(static_cast<unsigned char>(c)) == 0) return "";
  }
  return word.size() == 32 && word.find_first_not_of('0') != std::string::npos ? word : "";
}

void take_key(const std::string& text) {
  using hal::linux_host::AuthenticationKey;
  const auto file = fuzz::folder().write("key", text);
  std::filesystem::permissions(file,
                               std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
  AuthenticationKey wanted;
  wanted.bytes[0] = 77;  // the one before
  AuthenticationKey key = wanted;
  hal::linux_host::Reason reason;
  const bool taken = hal::linux_host::read_key(file.c_str(), key, reason);
  const std::string digits = key_in(text);
  expect(taken == !digits.empty(), "a key is 32 hexadecimal digits, not all zeros, and nothing else");
  for (std::size_t i = 0; taken && i < sizeof wanted.bytes; ++i)
    wanted.bytes[i] = static_cast<std::uint8_t>(std::stoul(digits.substr(2 * i, 2), nullptr, 16));
  expect(std::memcmp(key.bytes, wanted.bytes, sizeof key.bytes) == 0, "a key is as it stands, or untouched");
  expect(taken || std::strstr(reason.text, file.c_str()) != nullptr, "a reason names the file");
}

void check(const clips::Clip& clip) {
  const auto known = [&](int lane) { return lane >= -1 && lane < static_cast<int>(clip.lanes.size()); };
  for (const clips::ClipLane& lane : clip.lanes) {
    expect(lane.centre.length_m() >= 0.1 && lane.centre.length_m() <= 1e4 && lane.width_m <= 100.0 &&
               lane.speed_limit_mps > 0.0 && lane.speed_limit_mps <= 200.0,
           "a lane is one of a road");
    expect(known(lane.left) && known(lane.right), "lanes beside are the clip's");
    for (const int next : lane.successors) expect(next >= 0 && known(next), "lanes behind are the clip's");
  }
  for (const clips::ClipVehicle& vehicle : clip.vehicles) {
    expect(vehicle.length_m > 0.0 && vehicle.width_m > 0.0, "a vehicle has a size");
    for (const auto& [step, state] : vehicle.states) {
      expect(step >= 0 && step <= 100'000 && std::abs(state.centre.x) <= 1e8 &&
                 std::abs(state.centre.y) <= 1e8 && std::abs(state.heading_rad) <= 1000.0 &&
                 std::abs(state.speed_mps) <= 200.0,
             "a state is one of a drive");
    }
  }
}

void forecast(const clips::Clip& clip) {
  static const std::vector<std::unique_ptr<clips::Forecaster>> floors = [] {
    std::vector<std::unique_ptr<clips::Forecaster>> all;
    for (const char* name : {"constant_acceleration", "constant_turn_rate", "lane_following"})
      all.push_back(clips::make_forecaster(name));
    return all;
  }();
  std::vector<clips::Window> windows = clips::Windows().of(clip);
  if (windows.size() > kWindows) windows.resize(kWindows);
  for (const clips::Window& window : windows) {
    for (const auto& floor : floors) {
      for (const clips::ClipFuture& future : floor->forecast(clip, window.vehicle, window.step)) {
        for (const map::Vec2 place : future.places)
          expect(std::isfinite(place.x) && std::isfinite(place.y), "a forecast leads somewhere");
      }
    }
  }
}

void take_clip(const std::string& text) {
  const auto file = fuzz::folder().write("fuzz.json", text);
  static_cast<void>(fuzz::accepts("fuzz.json", [&] {
    const clips::Clip clip = clips::load_clip(file);
    check(clip);
    forecast(clip);
  }));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Input input(data, size);
  switch (input.byte()) {
    case 'k':
      take_key(input.rest());
      break;
    case 'c':
      take_clip(input.rest());
      break;
    case 'm':
      check(faults::make_script(input.take<std::uint64_t>(), {"cruise", "left_turn"}));
      break;
    default:
      take_script(input.rest());
  }
  return 0;
}
