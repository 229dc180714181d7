#pragma once
/// A drive straight on, told to the plausibility monitor.

#include <gtest/gtest.h>

#include <functional>

#include "firmware/ecu/plausibility.hpp"

namespace s4tp::ecu {

/// An honest car, told of every 10 ms, its pose every 20 ms; a lie may change what is told.
struct Drive {
  using Lie = std::function<void(float since_s, Measured& told)>;
  static constexpr float kSpeed_mps = 10.0F;
  static constexpr int kRunTicks = 3000;  // 30 s

  Measured truth;
  Commanded commanded;
  const wire::Map* map = nullptr;
  PlausibilityMonitor monitor;
  Parameters parameters;
  int tick = 0;

  Drive() {
    truth.known = true;
    truth.motion = true;
    truth.passed_ms = 10;
    truth.speed_mps = kSpeed_mps;
    commanded.active = true;
  }
  /// \return ticks until the check fails, -1: never within `limit`
  int until(Check check, const Lie& lie, int limit = kRunTicks) {
    for (int i = 1; i <= limit; ++i) {
      step(lie, 0.01F * static_cast<float>(i));
      if (monitor.failed(check)) return i;
    }
    return -1;
  }
  void step(const Lie& lie, float since_s) {
    truth.rear_axle.x_m += 0.01F * truth.speed_mps;
    truth.pose = ++tick % 2 == 0;
    Measured told = truth;
    if (lie) lie(since_s, told);
    monitor.update(told, commanded, map, parameters);
  }
  void honest(int ticks) {
    for (int i = 0; i < ticks; ++i) step(nullptr, 0.0F);
  }
};

/// At 10 m/s, after a second of the truth.
inline int ticks_until(Check check, const Drive::Lie& lie) {
  Drive drive;
  drive.honest(100);
  EXPECT_EQ(drive.monitor.faults(), 0U);
  return drive.until(check, lie);
}

}  // namespace s4tp::ecu
