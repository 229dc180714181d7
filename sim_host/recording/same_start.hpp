#pragma once
/// A moment of a log whose world cannot be made again, but whose roads are known, becomes a scenario: `replay
/// FILE --cut T --out DIR --scenario NAME`.

#include <filesystem>

#include "sim_host/recording/drive_note.hpp"
#include "sim_host/world/scenario/scenario.hpp"

namespace s4tp::recording {

struct StartMade {
  int told = 0;      ///< vehicles of the track list then
  int left_out = 0;  ///< of them: inside a junction, or on no lane
  int there = 0;     ///< of the others: there from the first step on; those left wait for room at their place
};

/// REC-031 A scenario folder with the start of that instant: us on our lane at our speed, every vehicle the
/// ECU had been told of on its lane at its speed, straight on with default drivers; the goal is that of
/// `roads`. Where exactly in the lane and how turned they were is lost.
/// \param note   who drove  \param start_s  since the log's first tick  \param folder  new, or empty
/// \throws std::runtime_error when the log does not hold the instant, or where we were is no start
StartMade write_same_start(const std::filesystem::path& file, const DriveNote& note, double start_s,
                           const scenario::Scenario& roads, const std::filesystem::path& folder);

}  // namespace s4tp::recording
