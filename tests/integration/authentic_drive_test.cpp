// The whole loop with authentication around both ends: what it changes (nothing), and what a stranger on the
// bus can do (nothing that moves the car). Without authentication the same stranger takes the car over.
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "firmware/ecu/records.hpp"
#include "firmware/secoc/frames.hpp"
#include "hal/sim/null_devices.hpp"
#include "sim_host/baselines/any_ecu.hpp"
#include "sim_host/world/world.hpp"
#include "tests/support/secoc_rig.hpp"

namespace s4tp {
namespace {

namespace fs = std::filesystem;
using Frames = std::vector<wire::Frame>;

scenario::Scenario scenario(const std::string& name) {
  return scenario::load_scenario(fs::path(S4TP_SOURCE_DIR) / "sim_host" / "scenarios" / name);
}

/// Plans in force, by the tick from which on they are.
struct Plans final : hal::Telemetry {
  bool publish(std::uint16_t kind, const void* record, std::uint32_t) override {
    if (static_cast<ecu::RecordKind>(kind) == ecu::RecordKind::kPlan)
      digests[tick] = static_cast<const ecu::PlanRecord*>(record)->digest;
    return true;
  }
  int tick = 0;
  std::map<int, std::uint32_t> digests;
};

/// World and ECU on one bus, with keys or without, and a stranger's port.
class Drive {
 public:
  /// \param keyed  both ends authenticate
  Drive(const scenario::Scenario& scenario, bool keyed) : world_(scenario, {}) {
    if (keyed) {
      const hal::linux_host::AuthenticationKey key = secoc::new_key();
      ecu_keys.emplace(key);
      world_keys.emplace(key);
      ecu_end.emplace(*ecu_port_, *ecu_keys, secoc::End::kEcu);
      world_end.emplace(*world_port_, *world_keys, secoc::End::kWorld);
      // As the two processes meet before the first tick.
      ecu_end->announce();
      hal::CanFrame nothing;
      EXPECT_FALSE(world_end->receive(nothing));
      world_end->announce();
    }
    bus_.fault = &wire;
    ecu_ = baselines::make_ecu("s4tp", true, Parameters{},
                               {&over(ecu_end, *ecu_port_), &cycles_, &watchdog_, &plans}, nullptr);
  }

  bool tick() {
    if (world_.finished()) return false;
    ++plans.tick;
    wire.seen.clear();
    frames_.clear();
    world_.tick(frames_);
    hal::Can& world_can = over(world_end, *world_port_);
    for (const wire::Frame& frame : frames_) (void)world_can.send(to_hal(frame));
    if (before_ecu) before_ecu();
    ecu_->control_tick();
    if (ecu_->planning_due()) ecu_->planning_cycle();
    if (before_world) before_world();
    hal::CanFrame frame;
    while (world_can.receive(frame)) {
      const wire::Frame taken = to_wire(frame);
      if (taken.id == wire::kCommandId) commands.push_back(taken);
      world_.receive(taken);
    }
    return true;
  }
  void run(double until_s = 1e9) {
    while (world_.time_s() < until_s && tick()) {
    }
  }
  void inject(const wire::Frame& frame) {
    wire.enabled = false;
    (void)stranger_->send(to_hal(frame));
    wire.enabled = true;
  }
  [[nodiscard]] const world::World& world() const { return world_; }
  [[nodiscard]] const ecu::EcuCore& core() const { return ecu_->core(); }
  [[nodiscard]] double speed_mps() const { return world_.recording().snapshots.back().ego.speed_mps; }

  std::function<void()> before_ecu;
  std::function<void()> before_world;
  secoc::Wire wire;  ///< this tick's frames, as they were on the bus
  Plans plans;
  Frames commands;
  std::optional<secoc::TestKeys> ecu_keys, world_keys;
  std::optional<secoc::AuthenticCan> ecu_end, world_end;

 private:
  static hal::Can& over(std::optional<secoc::AuthenticCan>& end, hal::Can& port) {
    return end ? static_cast<hal::Can&>(*end) : port;
  }
  world::World world_;
  hal::sim::Bus bus_;
  hal::sim::Bus::Port* world_port_ = bus_.attach();
  hal::sim::Bus::Port* ecu_port_ = bus_.attach();
  hal::sim::Bus::Port* stranger_ = bus_.attach();
  hal::sim::NullCycleCounter cycles_;
  hal::sim::NullWatchdog watchdog_;
  std::unique_ptr<baselines::AnyEcu> ecu_;
  Frames frames_;
};

// AUTH-040 Four whole drives with authentication and without: the same plans in the same ticks to the bit,
// the same ending.
TEST(AuthenticDrive, SamePlansToTheBit) {
  for (const char* const name : {"left_turn", "merge", "cruise", "overtake"}) {
    const scenario::Scenario road = scenario(name);
    const auto plain = std::make_unique<Drive>(road, false);
    const auto keyed = std::make_unique<Drive>(road, true);
    plain->run();
    keyed->run();
    EXPECT_GT(plain->plans.digests.size(), 50U) << name;
    EXPECT_EQ(plain->plans.digests, keyed->plans.digests) << name;
    EXPECT_EQ(plain->world().recording().ending, keyed->world().recording().ending) << name;
    EXPECT_EQ(keyed->ecu_end->tally().refused, 0U) << name;
    EXPECT_EQ(keyed->world_end->tally().refused, 0U) << name;
  }
}

/// A stranger who reads the bus and says in the ECU's name, with CRC and counter as they ought to be: full
/// throttle. Before the ECU's own command, so that the forged one is the one whose counter fits.
class Impostor {
 public:
  explicit Impostor(Drive& drive) : drive_(drive) {
    drive.before_ecu = [this] { speak(); };
  }
  int said = 0;

 private:
  void speak() {
    if (drive_.commands.empty() && said == 0 && drive_.world().time_s() < 2.0) return;
    wire::Command command;
    command.acceleration_mps2 = 2.5F;
    command.mode = static_cast<std::uint8_t>(ecu::Mode::kDriving);
    drive_.inject(secoc::SecocRig::protect(command, counter_));
    ++said;
  }
  Drive& drive_;
  wire::E2eSender counter_;
};

// AUTH-041 The ECU is silenced (its commands are lost on the way) and a stranger commands full throttle in
// its place. Without authentication the car obeys; with it the car brakes by itself and stands.
TEST(AuthenticDrive, AForgedCommandDoesNotMoveTheCar) {
  scenario::Scenario road = scenario("cruise");
  road.flows.clear();  // nobody to run into at full throttle: the drive would end there
  double speeds_mps[2] = {};
  for (const bool keyed : {false, true}) {
    const auto drive = std::make_unique<Drive>(road, keyed);
    drive->run(2.0);
    const double before_mps = drive->speed_mps();
    EXPECT_GT(before_mps, 5.0);
    drive->wire.lost = [](const wire::Frame& frame) {
      return frame.id == wire::kCommandId || frame.id == wire::kCommandAuthId;
    };
    Impostor impostor(*drive);
    drive->run(4.5);
    speeds_mps[keyed ? 1 : 0] = drive->speed_mps() - before_mps;
    EXPECT_GT(impostor.said, 200);
  }
  EXPECT_GT(speeds_mps[0], 2.0) << "without authentication it drives the car";
  EXPECT_LT(speeds_mps[1], -5.0) << "with it the car brakes";
}

// AUTH-041 Beside a living ECU: forged commands and recorded ones with their companions, in every tick, change
// neither one plan nor one command that the car takes.
TEST(AuthenticDrive, ForgedAndReplayedCommandsChangeNothing) {
  const scenario::Scenario road = scenario("left_turn");
  const auto alone = std::make_unique<Drive>(road, true);
  alone->run();
  const auto attacked = std::make_unique<Drive>(road, true);
  Impostor impostor(*attacked);
  Frames recorded;
  std::size_t next = 0;
  attacked->before_world = [&] {
    for (const wire::Frame& frame : attacked->wire.seen) {
      if (frame.id == wire::kCommandId || frame.id == wire::kCommandAuthId) recorded.push_back(frame);
    }
    if (recorded.size() < 200) return;
    for (int i = 0; i < 4; ++i) attacked->inject(recorded[next++ % (recorded.size() - 100)]);
  };
  attacked->run();
  EXPECT_GT(impostor.said, 300);
  EXPECT_GT(next, 1000U);
  EXPECT_EQ(alone->plans.digests, attacked->plans.digests);
  ASSERT_EQ(alone->commands.size(), attacked->commands.size());
  for (std::size_t i = 0; i < alone->commands.size(); ++i)
    ASSERT_TRUE(secoc::same(alone->commands[i], attacked->commands[i])) << i;
  EXPECT_GT(attacked->world_end->tally().refused, 500U);
}

// AUTH-041 Forged motion, steering and pose, said right before the genuine ones, and whole recorded groups:
// the ECU's picture of itself and its plans are the same as without the stranger.
TEST(AuthenticDrive, ForgedMotionIsNotBelieved) {
  const scenario::Scenario road = scenario("left_turn");
  const auto alone = std::make_unique<Drive>(road, true);
  alone->run();
  const auto attacked = std::make_unique<Drive>(road, true);
  wire::E2eSender motion;
  wire::E2eSender pose;
  Frames recorded;
  std::size_t next = 0;
  // Said behind the last tick, as if at the beginning of this one.
  attacked->before_world = [&] {
    for (const wire::Frame& frame : attacked->wire.seen) {
      const bool of_group = frame.id == wire::kMotionId || frame.id == wire::kSteeringId ||
                            frame.id == wire::kPoseId || frame.id == wire::kMotionAuthId;
      if (of_group) recorded.push_back(frame);
    }
    wire::Motion fast;
    fast.speed_mps = 30.0F;
    attacked->inject(secoc::SecocRig::protect(fast, motion));
    wire::Pose far;
    far.x_m = 500.0F;
    attacked->inject(secoc::SecocRig::protect(far, pose));
    attacked->inject(wire::Frame{wire::kMotionAuthId, 8, {1, 2, 3, 4, 5, 6, 7, 8}});
    for (int i = 0; i < 4 && recorded.size() > 100; ++i) attacked->inject(recorded[next++ % recorded.size()]);
  };
  attacked->run();
  EXPECT_GT(next, 1000U);
  EXPECT_EQ(alone->plans.digests, attacked->plans.digests);
  EXPECT_EQ(attacked->core().faults(), alone->core().faults());
  EXPECT_GT(attacked->ecu_end->tally().refused, 500U);
}

// AUTH-041 Whole recorded lists with their companions, as they were and in turn with the time of now, said
// between the genuine ones: the same plans as without the stranger, each companion refused.
TEST(AuthenticDrive, ReplayedListsAreNotBelieved) {
  const scenario::Scenario road = scenario("left_turn");
  const auto alone = std::make_unique<Drive>(road, true);
  alone->run();
  const auto attacked = std::make_unique<Drive>(road, true);
  std::vector<Frames> recorded(1);  // the last one is still being said
  std::uint32_t said = 0;
  attacked->before_world = [&] {
    for (const wire::Frame& frame : attacked->wire.seen) {
      const bool closes = frame.id == wire::kTrackListAuthId;
      if (closes || frame.id == wire::kTrackListId || secoc::is_member(frame.id))
        recorded.back().push_back(frame);
      if (closes) recorded.emplace_back();
    }
    // A list slipped into a genuine one would keep that out.
    if (!recorded.back().empty() || recorded.size() < 30) return;
    Frames old = recorded[said % (recorded.size() - 10)];
    wire::TrackList header;
    ASSERT_TRUE(wire::decode(old.front(), header));
    header.vehicle_time_ms = static_cast<std::uint16_t>(1000.0 * attacked->world().time_s());
    if (++said % 2 == 0) {
      ASSERT_TRUE(wire::encode(header, old.front()));
      wire::e2e_seal(old.front());
    }
    for (const wire::Frame& frame : old) attacked->inject(frame);
  };
  attacked->run();
  EXPECT_GT(said, 300U);
  EXPECT_EQ(alone->plans.digests, attacked->plans.digests);
  EXPECT_EQ(attacked->core().faults(), alone->core().faults());
  EXPECT_GE(attacked->ecu_end->tally().refused + 1, said) << "the last one is heard by nobody";
}

// AUTH-042 What authentication keeps out is missing, and that is seen: with companions of the motion group
// lost, the ECU reports motion, pose and steering missing, stops the car and counts nothing as genuine.
TEST(AuthenticDrive, WhatIsKeptOutIsReported) {
  const scenario::Scenario road = scenario("cruise");
  const auto drive = std::make_unique<Drive>(road, true);
  drive->run(2.0);
  EXPECT_EQ(drive->core().mode(), ecu::Mode::kDriving);
  drive->wire.lost = [](const wire::Frame& frame) { return frame.id == wire::kMotionAuthId; };
  drive->run(2.5);
  EXPECT_NE(drive->core().faults() & ecu::bit(ecu::FaultBit::kMotionMissing), 0U);
  EXPECT_NE(drive->core().faults() & ecu::bit(ecu::FaultBit::kPoseMissing), 0U);
  EXPECT_EQ(drive->core().mode(), ecu::Mode::kMinimumRisk);
}

}  // namespace
}  // namespace s4tp
