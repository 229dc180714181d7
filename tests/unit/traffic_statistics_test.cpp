#include "sim_host/metrics/traffic_statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

#include "sim_host/metrics/traffic_figures.hpp"

namespace s4tp::metrics {
namespace {

using map::Lane;
using map::LaneId;
using map::Network;
using traffic::CarState;
using traffic::Snapshot;

/// Where a car is at a time; false: not there.
using Motion = std::function<bool(double time_s, CarState& car)>;

std::vector<Snapshot> record(double until_s, const std::vector<Motion>& cars) {
  std::vector<Snapshot> snapshots;
  for (int i = 0; i * 0.1 <= until_s + 1e-9; ++i) {
    Snapshot snapshot;
    snapshot.time_s = i * 0.1;
    for (std::size_t id = 0; id < cars.size(); ++id) {
      CarState car;
      car.id = static_cast<int>(id) + 1;
      if (cars[id](snapshot.time_s, car)) {
        snapshot.others.push_back(car);
      }
    }
    snapshots.push_back(snapshot);
  }
  return snapshots;
}

Lane lane(map::Vec2 from, map::Vec2 to, bool in_junction) {
  Lane made;
  made.centre = map::Polyline({from, to});
  made.in_junction = in_junction;
  return made;
}

/// \code
///                 | 3..5 northwards along x = 105, the junction from y = -10 to 10; yields
///   0 ----[ 1 ]------ 2 eastwards along y = 0, the junction from x = 95 to 115
///                 |
/// \endcode
/// Shared ground: x from 102 to 108, y from -3 to 3.
Network crossing() {
  Network network;
  network.lanes = {lane({0, 0}, {95, 0}, false),      lane({95, 0}, {115, 0}, true),
                   lane({115, 0}, {200, 0}, false),   lane({105, -100}, {105, -10}, false),
                   lane({105, -10}, {105, 10}, true), lane({105, 10}, {105, 100}, false)};
  for (const LaneId first : {0, 1, 3, 4}) {
    network.lanes[static_cast<std::size_t>(first)].successors = {first + 1};
    network.lanes[static_cast<std::size_t>(first) + 1].predecessors = {first};
  }
  network.conflicts = {{1, 4, map::Rule::kFirstHasPriority, 7.0, 13.0, 7.0, 13.0}};
  return network;
}

/// Eastwards at 10 m/s, at x = 102 at a time.
Motion eastwards(double there_s) {
  return [=](double time_s, CarState& car) {
    const double x = 102.0 + 10.0 * (time_s - there_s);
    car.centre = {x, 0.0};
    car.speed_mps = 10.0;
    car.lane = x < 95.0 ? 0 : x < 115.0 ? 1 : 2;
    return x >= 0.0 && x < 200.0;
  };
}

/// Stands with its bumper 0.5 m before the line, from 9.2 s on northwards at 5 m/s.
bool northwards(double time_s, CarState& car) {
  const double y = -13.0 + 5.0 * std::max(0.0, time_s - 9.2);
  car.centre = {105.0, y};
  car.heading_rad = 1.5707963;
  car.speed_mps = time_s > 9.2 ? 5.0 : 0.0;
  car.lane = y < -10.0 ? 3 : y < 10.0 ? 4 : 5;
  return true;
}

// Bumper over the line (y = -10, centre at -12.5) at 9.2 + 0.5 / 5 = 9.3 s, on the shared ground (centre at
// -3) at 11.2 s: 1.9 s later. The others, there at 5, 8 and 14 s, count at the line at 3.1, 6.1 and 12.1 s.
// First in line from 0 s on: 3.1 and 3.0 s rejected, 6.0 s accepted.
TEST(TrafficStatistics, GapsAtAJunction) {
  const TrafficSamples samples = observe_traffic(
      crossing(), record(16.0, {eastwards(5.0), eastwards(8.0), eastwards(14.0), northwards}));
  ASSERT_EQ(samples.rejected_s.size(), 2U);
  EXPECT_NEAR(samples.rejected_s[0], 3.1, 1e-6);
  EXPECT_NEAR(samples.rejected_s[1], 3.0, 1e-6);
  ASSERT_EQ(samples.accepted_s.size(), 1U);
  EXPECT_NEAR(samples.accepted_s[0], 6.0, 1e-6);
  const std::vector<GapChoice>& choices = samples.choices.at(Manoeuvre::kStraight);
  ASSERT_EQ(choices.size(), 1U);
  EXPECT_NEAR(choices[0].largest_rejected_s, 3.1, 1e-6);
  EXPECT_NEAR(choices[0].accepted_s, 6.0, 1e-6);
  EXPECT_NEAR(samples.waits_s.at(Manoeuvre::kStraight).at(0), 9.3, 1e-6);
}

// The second leaves the shared ground at 8 + 6 / 10 = 8.6 s, the other one enters it at 11.2 s: 2.6 s, and leaves it
// at 12.4 s, the third enters it at 14 s: 1.6 s. Two of the same lane are no encroachment.
TEST(TrafficStatistics, PostEncroachmentTime) {
  const TrafficSamples samples = observe_traffic(
      crossing(), record(16.0, {eastwards(5.0), eastwards(8.0), eastwards(14.0), northwards}));
  ASSERT_EQ(samples.post_encroachment_s.size(), 2U);
  EXPECT_NEAR(samples.post_encroachment_s[0], 2.6, 1e-6);
  EXPECT_NEAR(samples.post_encroachment_s[1], 1.6, 1e-6);
}

// Bumpers pass the middle of lane 0 (x = 47.5) 5.7 s before x = 102: at 2.3 and 8.3 s (the first one was past
// it at 0 s): 6 s; the middle of lane 2 (x = 157.5) 5.3 s after it: at 10.3, 13.3 s (19.3 s is too late): 3
// s.
TEST(TrafficStatistics, Headways) {
  TrafficSamples samples =
      observe_traffic(crossing(), record(16.0, {eastwards(5.0), eastwards(8.0), eastwards(14.0)}));
  ASSERT_EQ(samples.headways_s.size(), 2U);
  EXPECT_NEAR(samples.headways_s[0], 6.0, 1e-6);
  EXPECT_NEAR(samples.headways_s[1], 3.0, 1e-6);
}

// 20 m from centre to centre, cars of 5 m, 10 m/s: 15 m are 1.5 s. One that drives 2 m/s slower than its
// leader does not follow it.
TEST(TrafficStatistics, TimeGapWhileFollowing) {
  const auto at = [](double x_m, double speed_mps) {
    return [=](double, CarState& car) {
      car.centre = {x_m, 0.0};
      car.speed_mps = speed_mps;
      car.lane = 0;
      return true;
    };
  };
  const TrafficSamples samples =
      observe_traffic(crossing(), record(0.1, {at(80, 10), at(60, 10), at(40, 8)}));
  ASSERT_EQ(samples.following_gaps_s.size(), 2U);  // of one car, in two snapshots
  EXPECT_NEAR(samples.following_gaps_s[0], 1.5, 1e-9);
}

// Two cars overlap from 1 to 2 s: one collision; they are there for 3 s each, and stay.
TEST(TrafficStatistics, CollisionsCountOnceAPair) {
  const auto touching = [](double time_s, CarState& car) {
    car.centre = {time_s > 0.95 && time_s < 2.05 ? 44.0 : 30.0, 0.0};
    car.lane = 0;
    return true;
  };
  const auto still = [](double, CarState& car) {
    car.centre = {48.0, 0.0};
    car.lane = 0;
    return true;
  };
  const TrafficSamples samples = observe_traffic(crossing(), record(3.0, {touching, still}));
  EXPECT_EQ(samples.collisions, 1);
  EXPECT_EQ(samples.vehicles, 2);
  EXPECT_EQ(samples.finished, 0);
  EXPECT_NEAR(samples.vehicle_s, 6.0, 1e-9);
  EXPECT_NEAR(samples.observed_s, 3.0, 1e-9);
}

/// Lane 0 ends after 100 m; lane 1 beside it goes on.
Network lane_drop() {
  Network network;
  network.lanes = {lane({0, 0}, {100, 0}, false), lane({0, 3.2}, {100, 3.2}, false),
                   lane({100, 3.2}, {200, 3.2}, false)};
  network.lanes[0].left = 1;
  network.lanes[1].right = 0;
  network.lanes[1].successors = {2};
  network.lanes[2].predecessors = {1};
  return network;
}

// At 10 m/s 25 m apart the cars on lane 1 leave 20 m = 2 s between bumpers; the second passes the one who
// stands at x = 50 on lane 0 at 4 s. Behind it the gap is 40 - 5 = 35 m = 3.5 s: it is taken at 5 s, when the
// next one is at x = 20, 25 m or 2.5 s behind its bumper, and the one before it at x = 60, 5 m ahead.
TEST(TrafficStatistics, GapsWhereALaneEnds) {
  const auto on_lane_1 = [](double start_m) {
    return [=](double time_s, CarState& car) {
      car.centre = {start_m + 10.0 * time_s, 3.2};
      car.speed_mps = 10.0;
      car.lane = 1;
      return car.centre.x >= 0.0 && car.centre.x < 100.0;
    };
  };
  const auto merging = [](double time_s, CarState& car) {
    car.centre = {50.0, 0.0};
    car.speed_mps = 10.0;
    car.lane = time_s < 4.95 ? 0 : 1;
    return true;
  };
  const TrafficSamples samples = observe_traffic(
      lane_drop(), record(5.0, {on_lane_1(35.0), on_lane_1(10.0), on_lane_1(-30.0), merging}));
  const std::vector<GapChoice>& choices = samples.choices.at(Manoeuvre::kMerge);
  ASSERT_EQ(choices.size(), 1U);
  EXPECT_NEAR(choices[0].largest_rejected_s, 2.0, 1e-9);
  EXPECT_NEAR(choices[0].accepted_s, 3.5, 1e-9);
  ASSERT_EQ(samples.change_lags_s.size(), 1U);
  EXPECT_NEAR(samples.change_lags_s[0], 2.5, 1e-9);
  EXPECT_NEAR(samples.change_leads_s.at(0), 0.5, 1e-9);
  EXPECT_EQ(samples.changes, 1);
}

// Of 0, 1, 2, 3, 10: the median is 2, the lower quartile 1, 5 % lie at 0.2, the mean is 3.2.
TEST(TrafficStatistics, Quantiles) {
  const Distribution d = distribution_of({10.0, 0.0, 3.0, 1.0, 2.0});
  EXPECT_EQ(d.count, 5U);
  EXPECT_NEAR(d.p50, 2.0, 1e-12);
  EXPECT_NEAR(d.p25, 1.0, 1e-12);
  EXPECT_NEAR(d.p05, 0.2, 1e-12);
  EXPECT_NEAR(d.mean, 3.2, 1e-12);
}

// Three drivers between 2 and 4 s, three between 4 and 8 s: in the logarithm all is even about ln 4, so the
// median of the best log-normal law is 4 s. Mean and deviation give it back: median = mean / sqrt(1 +
// (deviation / mean)^2).
TEST(CriticalGap, SymmetryGivesTheMedian) {
  std::vector<GapChoice> choices(3, {2.0, 4.0});
  choices.insert(choices.end(), 3, {4.0, 8.0});
  choices.push_back({0.0, 1000.0});  // would have taken anything: says nothing
  choices.push_back({5.0, 4.0});     // inconsistent
  const CriticalGap gap = critical_gap(choices);
  EXPECT_EQ(gap.drivers, 6);
  EXPECT_EQ(gap.inconsistent, 1);
  EXPECT_NEAR(gap.mean_s / std::hypot(1.0, gap.deviation_s / gap.mean_s), 4.0, 0.01);
}

// 2000 drivers with log-normal critical gaps (mean 5 s, deviation 1 s) who are offered gaps at random until
// one is long enough: the estimate comes back within 2 %, though the accepted gaps themselves are far longer.
TEST(CriticalGap, RecoversTheDrivers) {
  std::mt19937_64 random(1);
  const double variance = std::log(1.0 + 0.04);
  std::lognormal_distribution<double> critical(std::log(5.0) - 0.5 * variance, std::sqrt(variance));
  std::exponential_distribution<double> offered(1.0 / 5.0);
  std::vector<GapChoice> choices;
  for (int i = 0; i < 2000; ++i) {
    const double own = critical(random);
    GapChoice choice;
    for (choice.accepted_s = offered(random); choice.accepted_s < own; choice.accepted_s = offered(random)) {
      choice.largest_rejected_s = std::max(choice.largest_rejected_s, choice.accepted_s);
    }
    choices.push_back(choice);
  }
  const CriticalGap gap = critical_gap(choices);
  EXPECT_NEAR(gap.mean_s, 5.0, 0.1);
  EXPECT_NEAR(gap.deviation_s, 1.0, 0.15);
}

// Two engines stand side by side, and the file has the same figures: 1 collision in 6 car-seconds is 600,000
// in 1000 car-hours.
TEST(TrafficFigures, StandSideBySide) {
  TrafficRun run{"crossing", "smarts", "builtin", 1, {}};
  run.samples.collisions = 1;
  run.samples.vehicle_s = 6.0;
  TrafficRun other = run;
  other.engine = "sumo";
  std::ostringstream text;
  write_traffic_tables(text, {run, other});
  EXPECT_NE(text.str().find("| builtin | sumo |"), std::string::npos);
  EXPECT_NE(text.str().find("1 (600000) | 1 (600000) |"), std::string::npos);
  const nlohmann::ordered_json json = traffic_json({run, other});
  ASSERT_EQ(json["traffic"].size(), 2U);
  EXPECT_NEAR(json["traffic"][1]["collisions_per_1000_vehicle_h"].get<double>(), 600000.0, 1e-6);
}

}  // namespace
}  // namespace s4tp::metrics
