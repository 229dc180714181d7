// Lane changes on whole drives: what was taken up is not dropped again at once.

#include <gtest/gtest.h>

#include <cstdio>

#include "sim_host/campaign/episode.hpp"

namespace s4tp::campaign {
namespace {

constexpr int kSoonCycles = 9;  // less than 0.9 s: not even half of a change

/// Changes that one drive takes up, and those that it drops at once.
struct Changes {
  int taken_up = 0;
  int dropped = 0;
};

Changes changes_of(const std::string& name, const std::string& flavour, std::uint64_t seed) {
  EpisodeOptions options;
  options.seed = seed;
  options.trace = true;
  const EpisodeResult result =
      run_episode(scenario::load_scenario(
                      std::filesystem::path(S4TP_SOURCE_DIR) / "sim_host" / "scenarios" / name, flavour),
                  options);
  Changes changes;
  scene::Manoeuvre before = scene::Manoeuvre::kKeep;
  int cycles = 0;  // that it has been the same
  for (const CycleTrace& cycle : result.trace->cycles) {
    const scene::Manoeuvre now = cycle.record.explanation.manoeuvre;
    if (cycle.ecu.mode != ecu::Mode::kDriving) continue;
    if (now != before) {
      if (before != scene::Manoeuvre::kKeep && cycles < kSoonCycles) ++changes.dropped;
      if (now != scene::Manoeuvre::kKeep) ++changes.taken_up;
      cycles = 0;
    }
    before = now;
    ++cycles;
  }
  return changes;
}

// BEHAV-002: a drive that took a change up and dropped it within 0.9 s while each cycle guessed anew what had been begun. Of the
// changes of twenty overtakes among social drivers one in ten at most is dropped so: 1 of 50 when this was written last, 8 of 56 before.
TEST(LaneChangeDrives, NothingIsDroppedAtOnce) {
  const Changes one = changes_of("merge", "social", 306);
  EXPECT_GT(one.taken_up, 0);
  EXPECT_EQ(one.dropped, 0);
  Changes all;
  for (std::uint64_t seed = 300; seed < 320; ++seed) {
    const Changes changes = changes_of("overtake", "social", seed);
    all.taken_up += changes.taken_up;
    all.dropped += changes.dropped;
  }
  std::printf("%d of %d changes dropped at once\n", all.dropped, all.taken_up);
  EXPECT_GT(all.taken_up, 20);
  EXPECT_LE(10 * all.dropped, all.taken_up);
}

}  // namespace
}  // namespace s4tp::campaign
