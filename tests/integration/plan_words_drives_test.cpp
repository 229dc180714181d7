// The words of plans on real drives name what is really there: checked against what the drive went on to
// show.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "sim_host/campaign/episode.hpp"
#include "sim_host/view/plan_words.hpp"

namespace s4tp::view {
namespace {

using campaign::CycleTrace;

constexpr int kSeeds = 6;

/// All drives of one scenario, seeds 0 to 5.
std::vector<campaign::EpisodeResult> drives(const std::string& name) {
  const scenario::Scenario scenario =
      scenario::load_scenario(std::filesystem::path(S4TP_SOURCE_DIR) / "sim_host" / "scenarios" / name);
  std::vector<campaign::EpisodeResult> results;
  for (int seed = 0; seed < kSeeds; ++seed) {
    campaign::EpisodeOptions options;
    options.seed = static_cast<std::uint64_t>(seed);
    options.trace = true;
    results.push_back(campaign::run_episode(scenario, options));
  }
  return results;
}

bool says(const std::vector<campaign::EpisodeResult>& results, const std::string& part) {
  return std::any_of(results.begin(), results.end(), [&](const campaign::EpisodeResult& result) {
    return std::any_of(
        result.trace->cycles.begin(), result.trace->cycles.end(),
        [&](const CycleTrace& cycle) { return in_words(cycle).find(part) != std::string::npos; });
  });
}

float distance_m(const Track& track, const Pose& pose) {
  return std::hypot(track.centre.x_m - pose.x_m, track.centre.y_m - pose.y_m);
}

/// How near vehicle `id` comes to the place we plan from in cycle `first` within the next 8 s.
float comes_within_m(const campaign::Trace& trace, std::size_t first, int id) {
  const Pose& place = trace.cycles[first].record.plan.trajectory.points[0].rear_axle;
  float nearest = 1e9F;
  for (std::size_t i = first; i < std::min(first + 80, trace.cycles.size()); ++i) {
    for (const Track& track : trace.cycles[i].tracks) {
      if (track.id == id) nearest = std::min(nearest, distance_m(track, place));
    }
  }
  return nearest;
}

// Every plan has words, and whoever they name is in sight.
TEST(PlanWordsOnDrives, NamesOnlyWhoIsThere) {
  for (const char* name : {"left_turn", "merge", "cruise", "overtake"}) {
    for (const campaign::EpisodeResult& result : drives(name)) {
      for (const CycleTrace& cycle : result.trace->cycles) {
        const Reason reason = reason_of(cycle);
        EXPECT_FALSE(in_words(cycle).empty());
        if (reason.track < 0) continue;
        EXPECT_TRUE(std::any_of(cycle.tracks.begin(), cycle.tracks.end(),
                                [&](const Track& track) { return track.id == reason.track; }))
            << name << ": " << in_words(cycle);
      }
    }
  }
}

// left_turn: we give way, and to somebody who does come by: within 15 m of where we are, in 8 s, 17 times
// in 20. The guard names whoever may come by law: one may turn off, or stop.
TEST(PlanWordsOnDrives, LeftTurnGivesWayToWhoComes) {
  int named = 0;
  int came = 0;
  const auto results = drives("left_turn");
  for (const campaign::EpisodeResult& result : results) {
    const campaign::Trace& trace = *result.trace;
    for (std::size_t i = 0; i + 80 < trace.cycles.size(); ++i) {
      const Reason reason = reason_of(trace.cycles[i]);
      const bool waits = reason.doing == Doing::kWaiting || reason.doing == Doing::kHalting;
      if (!waits || reason.because != Because::kGivingWay) continue;
      ++named;
      came += comes_within_m(trace, i, reason.track) < 15.0F ? 1 : 0;
    }
  }
  EXPECT_GT(named, 20);
  EXPECT_GE(20 * came, 17 * named) << came << " of " << named;
  EXPECT_TRUE(says(results, "the car from the left") || says(results, "the oncoming car"));
}

// merge: the ramp's lane has to be left for the lane beside it.
TEST(PlanWordsOnDrives, MergeHasToLeaveItsLane) {
  const auto results = drives("merge");
  EXPECT_TRUE(says(results, "Changing to the left lane"));
}

// cruise and overtake: who is slower ahead is the reason, and is ahead: in front of us and within 60 m.
TEST(PlanWordsOnDrives, FollowsWhoIsAhead) {
  int followed = 0;
  for (const char* name : {"cruise", "overtake"}) {
    for (const campaign::EpisodeResult& result : drives(name)) {
      for (const CycleTrace& cycle : result.trace->cycles) {
        const Reason reason = reason_of(cycle);
        if (reason.because != Because::kLeader) continue;
        ++followed;
        for (const Track& track : cycle.tracks) {
          if (track.id != reason.track) continue;
          const Pose& ours = cycle.record.plan.trajectory.points[0].rear_axle;
          const float ahead_m = (track.centre.x_m - ours.x_m) * std::cos(ours.heading_rad) +
                                (track.centre.y_m - ours.y_m) * std::sin(ours.heading_rad);
          EXPECT_GT(ahead_m, 0.0F) << in_words(cycle);
          EXPECT_LT(ahead_m, 60.0F) << in_words(cycle);
        }
      }
    }
  }
  EXPECT_GT(followed, 20);
}

}  // namespace
}  // namespace s4tp::view
