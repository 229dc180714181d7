#include "sim_host/world/nodes/perception.hpp"

#include <gtest/gtest.h>

#include <set>

namespace s4tp::nodes {
namespace {

traffic::CarState car(int id, double x, double y) {
  traffic::CarState state;
  state.id = id;
  state.centre = {x, y};
  state.speed_mps = 10.0;
  return state;
}

/// Publishes until nothing more comes. \return frames of the fullest tick
std::size_t receive(Perception& perception, std::uint32_t& now_ms, wire::TrackListReceiver& receiver) {
  std::size_t most = 0;
  for (int tick = 0; tick < 10; ++tick, now_ms += 10) {
    std::vector<wire::Frame> frames;
    perception.publish(now_ms, frames);
    most = std::max(most, frames.size());
    for (const wire::Frame& frame : frames) {
      (void)receiver.accept(frame);
    }
  }
  return most;
}

/// Three lists, so that the receiver trusts the header; the last one counts.
wire::Tracks seen(Perception& perception, const std::vector<traffic::CarState>& others) {
  wire::TrackListReceiver receiver;
  std::uint32_t now_ms = 0;
  for (int list = 0; list < 4; ++list) {
    perception.observe(car(0, 0.0, 0.0), others, now_ms);
    receive(perception, now_ms, receiver);
  }
  return receiver.tracks();
}

// WORLD-010 20 cars in range and one at 151 m: the nearest 16 are shown, nearest first, 4 counted as left
// out.
TEST(Perception, ShowsTheNearestSixteen) {
  std::vector<traffic::CarState> others{car(99, 151.0, 0.0)};
  for (int i = 20; i >= 1; --i) {
    others.push_back(car(i, 5.0 * i, 0.0));
  }
  Perception perception({}, {0.0, 0.0}, 1);
  const wire::Tracks tracks = seen(perception, others);
  ASSERT_EQ(tracks.count, 16);
  EXPECT_EQ(tracks.left_out, 4);
  EXPECT_NEAR(tracks.items[0].x_m, 5.0F, 0.006F);
  EXPECT_NEAR(tracks.items[15].x_m, 80.0F, 0.006F);
}

// WORLD-010 WIRE-020 Sixteen within 80 m drive as we do: one that is 15 m/s faster counts as 30 m nearer, and comes in from
// 110 m on instead of the last of them.
TEST(Perception, ShowsWhoCanBeNearSoonest) {
  for (const double away_m : {109.0, 111.0}) {
    std::vector<traffic::CarState> others{car(99, away_m, 0.0)};
    others[0].speed_mps = 25.0;
    for (int i = 1; i <= 16; ++i) others.push_back(car(i, 5.0 * i, 0.0));
    Perception perception({}, {0.0, 0.0}, 1);
    const wire::Tracks tracks = seen(perception, others);
    ASSERT_EQ(tracks.count, 16);
    float furthest_m = 0.0F;
    for (int i = 0; i < tracks.count; ++i) furthest_m = std::max(furthest_m, tracks.items[i].x_m);
    EXPECT_EQ(furthest_m > 100.0F, away_m < 110.0) << away_m;
  }
}

// Positions are relative to the odometry origin: 105 - 100 = 5 m.
TEST(Perception, SpeaksInOdometryCoordinates) {
  Perception perception({}, {100.0, 50.0}, 1);
  const wire::Tracks tracks = seen(perception, {car(3, 105.0, 48.0)});
  ASSERT_EQ(tracks.count, 1);
  EXPECT_NEAR(tracks.items[0].x_m, 5.0F, 0.006F);
  EXPECT_NEAR(tracks.items[0].y_m, -2.0F, 0.006F);
}

// WORLD-011 The longest list has 1 + 2 * 16 = 33 frames and takes three ticks of 12.
TEST(Perception, SpreadsAListOverThreeTicks) {
  std::vector<traffic::CarState> others;
  for (int i = 1; i <= 16; ++i) {
    others.push_back(car(i, 5.0 * i, 0.0));
  }
  Perception perception({}, {0.0, 0.0}, 1);
  std::uint32_t now_ms = 0;
  perception.observe(car(0, 0.0, 0.0), others, now_ms);
  std::vector<std::size_t> sizes;
  for (int tick = 0; tick < 4; ++tick, now_ms += 10) {
    std::vector<wire::Frame> frames;
    perception.publish(now_ms, frames);
    sizes.push_back(frames.size());
  }
  EXPECT_EQ(sizes, (std::vector<std::size_t>{12, 12, 9, 0}));
}

// Ids stay with their cars; switched at a rate of 10 / s, that is in every list, none stays.
TEST(Perception, KeepsIdsUnlessToldOtherwise) {
  const std::vector<traffic::CarState> others{car(300, 10.0, 0.0), car(556, 20.0, 0.0)};
  Perception steady({}, {0.0, 0.0}, 1);
  const wire::Tracks first = seen(steady, others);
  const wire::Tracks later = seen(steady, others);
  EXPECT_NE(first.items[0].id, first.items[1].id);
  EXPECT_EQ(first.items[0].id, later.items[0].id);
  scenario::PerceptionOptions options;
  options.id_switches_per_s = 10.0;
  Perception switching(options, {0.0, 0.0}, 1);
  EXPECT_NE(seen(switching, others).items[0].id, seen(switching, others).items[0].id);
}

// A car exactly behind another one cannot be seen when occlusion is on; beside it, it can.
TEST(Perception, HidesCarsBehindOthers) {
  scenario::PerceptionOptions options;
  options.occlusion = true;
  Perception perception(options, {0.0, 0.0}, 1);
  EXPECT_EQ(seen(perception, {car(1, 10.0, 0.0), car(2, 20.0, 0.0)}).count, 1);
  EXPECT_EQ(seen(perception, {car(1, 10.0, 0.0), car(2, 20.0, 6.0)}).count, 2);
}

// With a dropout of one half, 200 lists of one car show about 100, within 4 sigma = 28.
TEST(Perception, DropsTracks) {
  scenario::PerceptionOptions options;
  options.dropout = 0.5;
  Perception perception(options, {0.0, 0.0}, 1);
  wire::TrackListReceiver receiver;
  std::uint32_t now_ms = 0;
  int shown = 0;
  for (int list = 0; list < 200; ++list) {
    perception.observe(car(0, 0.0, 0.0), {car(1, 10.0, 0.0)}, now_ms);
    receive(perception, now_ms, receiver);
    shown += receiver.tracks().count;
  }
  EXPECT_NEAR(shown, 100, 28);
}

// Noise of 0.5 m is there, and of that size: the mean square of 400 draws lies within 0.25 +- 0.07.
TEST(Perception, AddsNoise) {
  scenario::PerceptionOptions options;
  options.position_noise_m = 0.5;
  Perception perception(options, {0.0, 0.0}, 1);
  double squares = 0.0;
  for (int i = 0; i < 400; ++i) {
    const double error = static_cast<double>(seen(perception, {car(1, 10.0, 0.0)}).items[0].x_m) - 10.0;
    squares += error * error / 400.0;
  }
  EXPECT_NEAR(squares, 0.25, 0.07);
}

// A latency of 10 ticks: nothing for 100 ms, then a list stamped with when it was seen.
TEST(Perception, DelaysLists) {
  scenario::PerceptionOptions options;
  options.latency_ticks = 10;
  Perception perception(options, {0.0, 0.0}, 1);
  perception.observe(car(0, 0.0, 0.0), {car(1, 10.0, 0.0)}, 1000);
  std::vector<wire::Frame> frames;
  perception.publish(1090, frames);
  EXPECT_TRUE(frames.empty());
  perception.publish(1100, frames);
  EXPECT_EQ(frames.size(), 3U);
}

}  // namespace
}  // namespace s4tp::nodes
