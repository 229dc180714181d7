// Lane changes on whole drives: what was taken up is not dropped again at once.

#include <gtest/gtest.h>

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

// BEHAV-002: three drives that took a change up and dropped it within 0.9 s while each cycle guessed anew what had been begun.
TEST(LaneChangeDrives, NothingIsDroppedAtOnce) {
  for (const auto& [name, flavour, seed] :
       {std::tuple{"merge", "social", 306}, std::tuple{"overtake", "social", 311},
        std::tuple{"overtake", "social", 314}}) {
    const Changes changes = changes_of(name, flavour, static_cast<std::uint64_t>(seed));
    EXPECT_GT(changes.taken_up, 0) << name << seed;
    EXPECT_EQ(changes.dropped, 0) << name << seed;
  }
}

}  // namespace
}  // namespace s4tp::campaign
