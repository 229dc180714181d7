#pragma once
/// A moment of a recorded drive becomes a scenario: `replay FILE --cut T --out DIR`.

#include <filesystem>
#include <stdexcept>

#include "sim_host/recording/drive_note.hpp"

namespace s4tp::recording {

inline constexpr double kBefore_s = 10.0;  ///< a cut begins so long before its moment

/// The drive's world cannot be made again; its start can (same_start.hpp).
class NoSuchWorld : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct CutMade {
  int start_tick = 0;
  double start_s = 0.0;  ///< since the ECU took over
};

/// REC-030 A scenario folder (world/scenario/cut.hpp) in which the world is that of the recording to the bit until
/// kBefore_s before the moment; from then on whoever drives does. With the planner and parameters of the
/// drive it goes on as recorded. \param moment_s  since the ECU took over \param folder  new, or empty
/// \throws std::runtime_error when the recording has no note or does not hold the moment; NoSuchWorld when its
/// beginning was not kept, or this program's world is not that of the recording: with the first difference
CutMade write_cut(const std::filesystem::path& file, double moment_s, const std::filesystem::path& folder);

}  // namespace s4tp::recording
