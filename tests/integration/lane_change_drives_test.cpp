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

// BEHAV-002: two drives that took a change up and dropped it within 0.9 s while each cycle guessed anew what had been begun. Of the
// changes of twenty overtakes among social drivers one in five at most is dropped so: 8 of 56 when this was written.
TEST(LaneChangeDrives, NothingIsDroppedAtOnce) {
  for (const auto& [name, seed] : {std::pair{"merge", 306}, std::pair{"overtake", 314}}) {
    const Changes changes = changes_of(name, "social", static_cast<std::uint64_t>(seed));
    EXPECT_GT(changes.taken_up, 0) << name << seed;
    EXPECT_EQ(changes.dropped, 0) << name << seed;
  }
  Changes all;
  for (std::uint64_t seed = 300; seed < 320; ++seed) {
    const Changes changes = changes_of("overtake", "social", seed);
    all.taken_up += changes.taken_up;
    all.dropped += changes.dropped;
  }
  std::printf("%d of %d changes dropped at once\n", all.dropped, all.taken_up);
  EXPECT_GT(all.taken_up, 20);
  EXPECT_LE(5 * all.dropped, all.taken_up);
}

}  // namespace
}  // namespace s4tp::campaign
