// Senders that lie, around the whole loop: how soon the plausibility monitor sees each lie, and that it never
// sees one where none is.

#include "sim_host/faults/lies.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "sim_host/campaign/fault_names.hpp"
#include "sim_host/faults/fault_run.hpp"

namespace s4tp::faults {
namespace {

constexpr ecu::Faults kImplausible =
    ecu::bit(ecu::FaultBit::kMotionImplausible) | ecu::bit(ecu::FaultBit::kSteeringImplausible) |
    ecu::bit(ecu::FaultBit::kPoseImplausible) | ecu::bit(ecu::FaultBit::kClockImplausible);

const Scenarios& shipped() {
  static const Scenarios scenarios = [] {
    Scenarios all;
    for (const std::string name : {"cruise", "cut_in", "left_turn", "left_turn_t", "merge", "overtake"}) {
      all.emplace(name, scenario::load_scenario(std::filesystem::path(S4TP_SOURCE_DIR) / "sim_host" /
                                                "scenarios" / name));
    }
    return all;
  }();
  return scenarios;
}

/// Of production sensors: wheel speed, accelerometer, gyroscope, steering sensor, positioning.
nodes::SensorOptions production_noise() {
  nodes::SensorOptions noise;
  noise.speed_noise_mps = 0.03;
  noise.acceleration_noise_mps2 = 0.2;
  noise.yaw_rate_noise_radps = 0.01;
  noise.steering_noise_rad = 0.003;
  noise.position_noise_m = 0.05;
  noise.heading_noise_rad = 0.005;
  noise.pose_latency_ticks = 3;
  return noise;
}

/// The same scenarios, where the ECU takes over at rest.
const Scenarios& from_rest() {
  static const Scenarios scenarios = [] {
    Scenarios all = shipped();
    for (auto& [name, scenario] : all) scenario.mission.start_speed_mps = 0.0;
    return all;
  }();
  return scenarios;
}

constexpr std::array<const char*, 3> kWhere{"cruise", "left_turn", "merge"};

struct Seen {
  double after_s = -1.0;  ///< from the lie or entry, whichever is later, to the tick with a fault; -1: never
  double off_m = 0.0;     ///< pose believed against the true one, at most until then
  double way_m = 0.0;     ///< from entry until then
  std::string answer;     ///< faults and mode of that tick
  double whole_way_m = 0.0;
  int plans_of_a_lie = 0;  ///< that took effect in a tick with a fault of ECU-100
  RunResult result;
};

double apart_m(const Pose& one, const Pose& other) {
  return static_cast<double>(distance(position(one), position(other)));
}

/// \param from_tick  of the lie; in tick 1 the ECU takes over
Seen expose(Lie lie, int from_tick, const Scenarios& scenarios, const std::string& name) {
  FaultScript script;
  script.seed = 3;
  script.scenario = name;
  script.faults.push_back(
      {FaultKind::kLie, from_tick, kForGood, traits(FaultKind::kLie).messages, static_cast<int>(lie), 1});
  const int first_tick = std::max(1, from_tick);
  Seen seen;
  Pose entry;
  std::uint32_t plan_ms = 0;
  RunOptions options;
  options.watch = [&](int tick, const ecu::EcuCore& core, const wire::Pose& sent) {
    const Pose pose{sent.x_m, sent.y_m, sent.heading_rad};
    const bool new_plan = core.plan().start_ms != std::exchange(plan_ms, core.plan().start_ms);
    if (new_plan && (core.faults() & ecu::kLyingFaults) != 0) ++seen.plans_of_a_lie;
    if (tick == 0) entry = pose;
    if (tick == from_tick - 1) {
      EXPECT_EQ(core.mode(), ecu::Mode::kDriving);
    }
    if (tick < first_tick) return;
    seen.whole_way_m = std::max(seen.whole_way_m, apart_m(entry, pose));
    if (seen.after_s >= 0.0) return;
    // The true pose is up to one tick older than what is believed.
    const EgoState& ego = core.inputs().ego();
    const double newer_m = 0.01 * static_cast<double>(ego.speed_mps);
    seen.off_m = std::max(seen.off_m, apart_m(ego.rear_axle, pose) - newer_m);
    if ((core.faults() & kImplausible) == 0) return;
    seen.after_s = 0.01 * (tick - first_tick + 1);
    seen.way_m = seen.whole_way_m;
    seen.answer = campaign::fault_names(core.faults() & kImplausible) + ", " + ecu::mode_name(core.mode());
  };
  seen.result = run_script(scenarios, script, options);
  return seen;
}

/// The cells behind a row's name in docs/plausibility.md: what it promises.
std::vector<std::string> promised(const std::string& name) {
  std::ifstream page(std::filesystem::path(S4TP_SOURCE_DIR) / "docs" / "plausibility.md");
  const std::string head = "| " + name + " | ";
  std::vector<std::string> cells;
  for (std::string line; std::getline(page, line);) {
    if (line.rfind(head, 0) != 0) continue;
    for (std::size_t at = head.size(), end = 0; (end = line.find(" |", at)) != std::string::npos;
         at = end + 3) {
      cells.push_back(line.substr(at, end - at));
    }
  }
  return cells;
}

/// What was measured is not more than the page says, nor less than half of it, but for the slack.
void expect_measured(double measured, const std::string& promise, double slack, const std::string& what) {
  EXPECT_LE(measured, std::stod(promise) + 1e-9) << what;
  EXPECT_GE(measured, 0.5 * std::stod(promise) - slack) << what;
}

/// Of two answers, the second is that at 8 m/s, in left_turn.
std::string answer_in(const std::string& scenario, const std::string& answers) {
  const std::size_t bar = answers.find(" / ");
  if (bar == std::string::npos) return answers;
  return scenario == "left_turn" ? answers.substr(bar + 3) : answers.substr(0, bar);
}

// PLAUS-001 .. PLAUS-011, ECU-096 .. ECU-100: each lie is seen in the loop as soon, and at as small an error of pose, as
// docs/plausibility.md says, and not much sooner either: its numbers are measured. The tick that sees it has the very faults and
// the mode that the page names. From that tick on no new plan takes effect, unless only the clock lies. Nobody is touched.
TEST(Lies, AreSeenAndAnsweredAsThePageSays) {
  for (int i = 0; i < kLies; ++i) {
    const auto lie = static_cast<Lie>(i);
    const std::string name = lie_name(lie);
    const std::vector<std::string> promise = promised(name);
    ASSERT_EQ(promise.size(), 4U) << "docs/plausibility.md has no row: " << name;
    Seen worst;
    for (const std::string scenario : kWhere) {
      const Seen seen = expose(lie, 100, shipped(), scenario);
      const std::string what = name + ", in " + scenario;
      ASSERT_GE(seen.after_s, 0.0) << what << ": never seen";
      worst.after_s = std::max(worst.after_s, seen.after_s);
      worst.off_m = std::max(worst.off_m, seen.off_m);
      EXPECT_EQ(seen.answer, answer_in(scenario, promise[2])) << what;
      EXPECT_EQ(seen.plans_of_a_lie, 0) << what;
      EXPECT_EQ(seen.result.verdict.breach, Breach::kNone) << what << ": " << seen.result.verdict.what;
      EXPECT_FALSE(seen.result.own_fault) << what;
    }
    std::printf("%-28s after %.2f s, pose off by %.2f m\n", name.c_str(), worst.after_s, worst.off_m);
    expect_measured(worst.after_s, promise[0], 0.0, name);
    expect_measured(worst.off_m, promise[1], 0.1, name);
  }
}

// PLAUS-009: the ECU takes over at rest, and speed and acceleration have always been told as 0. That it has set off is noticed
// as soon, and the vehicle got as far by then and until it stands, as docs/plausibility.md says.
TEST(Lies, SpeedFrozenFromRest) {
  const std::vector<std::string> promise = promised("speed and acceleration 0, from rest");
  ASSERT_EQ(promise.size(), 5U) << "docs/plausibility.md has no such row";
  Seen worst;
  for (const std::string scenario : kWhere) {
    const Seen seen = expose(Lie::kSpeedZero, -kPreRollTicks, from_rest(), scenario);
    ASSERT_GE(seen.after_s, 0.0) << scenario << ": never seen";
    worst.after_s = std::max(worst.after_s, seen.after_s);
    worst.way_m = std::max(worst.way_m, seen.way_m);
    worst.whole_way_m = std::max(worst.whole_way_m, seen.whole_way_m);
    EXPECT_EQ(seen.answer, promise[3]) << scenario;
    EXPECT_EQ(seen.result.verdict.breach, Breach::kNone) << scenario << ": " << seen.result.verdict.what;
  }
  std::printf("from rest: after %.2f s, %.2f m; stands after %.2f m\n", worst.after_s, worst.way_m,
              worst.whole_way_m);
  expect_measured(worst.after_s, promise[0], 0.0, "seen after");
  expect_measured(worst.way_m, promise[1], 0.0, "way by then");
  expect_measured(worst.whole_way_m, promise[2], 0.0, "way until it stands");
}

// PLAUS-001 .. PLAUS-012: in every shipped scenario, three seeds each, with production noise on all of the
// car's sensors, no check ever fails, before entry or after; what came nearest to its limit is printed.
TEST(Lies, NoFalseAlarm) {
  std::array<float, ecu::kCheckCount> highest{};
  for (const auto& [name, scenario] : shipped()) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      FaultScript script;
      script.seed = seed;
      script.scenario = name;
      RunOptions options;
      options.sensors = production_noise();
      ecu::Faults faults = 0;
      options.watch = [&](int, const ecu::EcuCore& core, const wire::Pose&) {
        faults |= core.plausibility().faults();
        for (int i = 0; i < ecu::kCheckCount; ++i) {
          float& high = highest.at(static_cast<std::size_t>(i));
          high = std::max(high, core.plausibility().share(static_cast<ecu::Check>(i)));
        }
      };
      (void)run_script(shipped(), script, options);
      EXPECT_EQ(faults, 0U) << name << " seed " << seed;
    }
  }
  for (int i = 0; i < ecu::kCheckCount; ++i) {
    const float share = highest.at(static_cast<std::size_t>(i));
    std::printf("check %d: %.2f of its limit at most\n", i, static_cast<double>(share));
  }
}

}  // namespace
}  // namespace s4tp::faults
