#include "sim_host/world/branch.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <stdexcept>
#include <vector>

#include "firmware/wire/codec.hpp"
#include "sim_host/world/world.hpp"
#include "tests/support/networks.hpp"
#include "tests/support/sealed_frames.hpp"

namespace s4tp::world {
namespace {

/// Drives by a function of time.
class ByTime final : public EgoDriver {
 public:
  explicit ByTime(std::function<EgoCommand(double)> law) : law_(std::move(law)) {}
  EgoCommand drive(const Branch& now) override { return law_(now.time_s()); }

 private:
  std::function<EgoCommand(double)> law_;
};

/// Commands one after the other.
class ByList final : public EgoDriver {
 public:
  EgoCommand drive(const Branch&) override { return commands.at(next_++); }
  std::vector<EgoCommand> commands;

 private:
  std::size_t next_ = 0;
};

/// An ECU that asks for whatever it is told to.
struct Ecu {
  /// \return the command as the car reads it off the bus
  EgoCommand command(World& world, const EgoCommand& wish) {
    wire::Command command;
    command.acceleration_mps2 = static_cast<float>(wish.acceleration_mps2);
    command.steering_rad = static_cast<float>(wish.steering_rad);
    const wire::Frame frame = s4tp::test::sealed(command, sender);
    world.receive(frame);
    EXPECT_TRUE(wire::decode(frame, command));
    return {static_cast<double>(command.acceleration_mps2), static_cast<double>(command.steering_rad)};
  }
  wire::E2eSender sender;
};

/// Slows down, goes on, steers a little: every part of the car moves.
EgoCommand restless(double time_s) {
  return {1.5 * std::sin(1.3 * time_s) - 0.4, 0.004 * std::sin(2.0 * time_s)};
}

void expect_same(const traffic::Snapshot& a, const traffic::CarState& ego,
                 const std::vector<traffic::CarState>& others) {
  ASSERT_EQ(a.ego.centre.x, ego.centre.x);
  ASSERT_EQ(a.ego.centre.y, ego.centre.y);
  ASSERT_EQ(a.ego.speed_mps, ego.speed_mps);
  ASSERT_EQ(a.ego.heading_rad, ego.heading_rad);
  ASSERT_EQ(a.ego.lane, ego.lane);
  ASSERT_EQ(a.others.size(), others.size());
  for (std::size_t i = 0; i < others.size(); ++i) {
    ASSERT_EQ(a.others[i].id, others[i].id);
    ASSERT_EQ(a.others[i].centre.x, others[i].centre.x);
    ASSERT_EQ(a.others[i].centre.y, others[i].centre.y);
    ASSERT_EQ(a.others[i].speed_mps, others[i].speed_mps);
    ASSERT_EQ(a.others[i].acceleration_mps2, others[i].acceleration_mps2);
  }
}

// WORLD-050 A branch given the commands that the world was given is the world, to the bit, for 5 s; and the
// world is what it would have been without the branches, one of which brakes meanwhile.
TEST(Branch, TheSameCommandsAreTheWorldItself) {
  for (const char* name : {"cut_in", "cruise"}) {
    const scenario::Scenario scenario = test::shipped(name);
    WorldOptions options;
    options.seed = 4;
    World world(scenario, options);
    World alone(scenario, options);
    Ecu ecu;
    Ecu other_ecu;
    ByList same;
    ByTime braking([](double) { return EgoCommand{-4.0, 0.0}; });
    std::unique_ptr<Branch> replayed;
    std::unique_ptr<Branch> braked;
    std::vector<wire::Frame> frames;
    while (!world.finished() && world.time_s() < 6.0) {
      frames.clear();
      world.tick(frames);
      alone.tick(frames);
      if (replayed) {
        braked->step();
      } else if (world.time_s() > 0.995) {
        replayed = world.fork(same);
        braked = world.fork(braking);
      }
      const EgoCommand taken = ecu.command(world, restless(world.time_s()));
      (void)other_ecu.command(alone, restless(world.time_s()));
      if (replayed) same.commands.push_back(taken);
    }
    ASSERT_GT(world.time_s(), 4.0) << name << ": the drive ended too early to show anything";
    ASSERT_GT(world.recording().snapshots.back().others.size(), 2U) << name << ": no traffic to compare";
    for (std::size_t tick = 0; tick + 10 < same.commands.size(); ++tick) {
      replayed->step();
      const traffic::Snapshot* shown = nullptr;  // the world records every tenth tick
      for (const traffic::Snapshot& snapshot : world.recording().snapshots) {
        if (std::abs(snapshot.time_s - replayed->time_s()) < 1e-6) shown = &snapshot;
      }
      if (shown != nullptr) expect_same(*shown, replayed->ego(), replayed->others());
      if (HasFatalFailure()) FAIL() << name << " at " << replayed->time_s() << " s";
    }
    EXPECT_GT(world.recording().snapshots.back().ego.speed_mps, braked->ego().speed_mps + 1.0);
    ASSERT_EQ(world.recording().snapshots.size(), alone.recording().snapshots.size());
    expect_same(alone.recording().snapshots.back(), world.recording().snapshots.back().ego,
                world.recording().snapshots.back().others);
  }
}

// Two branches of one instant: who drives on into the queue touches somebody, who brakes does not.
TEST(Branch, KeepsItsCollision) {
  const scenario::Scenario scenario = test::shipped("overtake");  // a slow lane ahead
  WorldOptions options;
  options.seed = 2;
  World world(scenario, options);
  std::vector<wire::Frame> frames;
  while (world.time_s() < 0.0) world.tick(frames);
  ByTime on([](double) { return EgoCommand{3.0, 0.0}; });
  ByTime brake([](double) { return EgoCommand{-6.0, 0.0}; });
  const std::unique_ptr<Branch> goes = world.fork(on);
  const std::unique_ptr<Branch> stops = world.fork(brake);
  for (int i = 0; i < 800; ++i) {
    goes->step();
    stops->step();
  }
  EXPECT_NE(goes->touched(), traffic::kNoCar);
  EXPECT_EQ(stops->touched(), traffic::kNoCar);
  EXPECT_NEAR(goes->time_s(), 8.0, 1e-6);
}

// Before the ECU drives there is nothing to decide.
TEST(Branch, BeginsAfterTheEntryOnly) {
  const scenario::Scenario scenario = test::shipped("cruise");
  World world(scenario, {});
  ByTime on(restless);
  EXPECT_THROW((void)world.fork(on), std::logic_error);
}

}  // namespace
}  // namespace s4tp::world
