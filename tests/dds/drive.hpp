#pragma once
/// A drive of the test's own, tick by tick, for whoever reads what its ECU tells.

#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "sim_host/campaign/driver.hpp"
#include "sim_host/telemetry/ecu_tap.hpp"
#include "sim_host/world/scenario/scenario.hpp"
#include "sim_host/world/world.hpp"
#include "tests/support/test_memory.hpp"

namespace s4tp::tests {

inline const std::string kTelemetry = std::string(S4TP_BINARY_DIR) + "/sim_host/s4tp-telemetry";

/// One a test process.
inline std::string memory_name() {
  return test_memory("dds");
}

inline scenario::Scenario shipped(const std::string& name) {
  return scenario::load_scenario(std::filesystem::path(S4TP_SOURCE_DIR) / "sim_host/scenarios" / name);
}

/// Of all frames the ECU sent: FNV-1a.
class FrameDigest {
 public:
  void add(const wire::Frame& frame) {
    for (int i = 0; i < frame.length; ++i) add(frame.data[i]);
    add(frame.id);
  }
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  void add(std::uint32_t part) { value_ = (value_ ^ part) * 1099511628211ULL; }
  std::uint64_t value_ = 14695981039346656037ULL;
};

/// Seed 3, with an ECU that tells what it does where a tap is given.
class Drive {
 public:
  explicit Drive(telemetry::EcuTap* tap, scenario::Scenario scenario = shipped("left_turn"))
      : scenario_(std::move(scenario)),
        driver_(campaign::make_driver("s4tp", true, Parameters{}, tap, tap)),
        world_(scenario_, options()) {}

  bool tick() {
    if (world_.finished()) return false;
    std::vector<wire::Frame> in;
    std::vector<wire::Frame> out;
    world_.tick(in);
    driver_->tick(in, out);
    for (const wire::Frame& frame : out) {
      world_.receive(frame);
      digest_.add(frame);
    }
    ++ticks_;
    return true;
  }
  /// \param pace  host time a tick, so that who reads sees each plan
  void ticks(int count, std::chrono::milliseconds pace) {
    for (int i = 0; i < count && tick(); ++i) std::this_thread::sleep_for(pace);
  }
  [[nodiscard]] std::uint64_t digest() const { return digest_.value(); }
  [[nodiscard]] int ticks_driven() const { return ticks_; }

 private:
  static world::WorldOptions options() {
    world::WorldOptions options;
    options.seed = 3;
    return options;
  }

  scenario::Scenario scenario_;
  std::unique_ptr<campaign::Driver> driver_;
  world::World world_;
  FrameDigest digest_;
  int ticks_ = 0;
};

}  // namespace s4tp::tests
