#pragma once
/// The drive every target must reproduce to the bit: a left turn that yields to a stop, starts again, changes
/// lane, and meanwhile loses perception long enough to be degraded and one planning deadline.

#include <cstdint>
#include <filesystem>

#include "sim_host/campaign/episode.hpp"
#include "sim_host/world/scenario/scenario.hpp"

namespace s4tp::campaign {

/// What a drive contained.
struct DriveContent {
  bool stopped = false;
  bool restarted = false;
  bool changed_lane = false;
  bool degraded = false;
  bool recovered = false;  ///< from degraded back to driving
  [[nodiscard]] bool complete() const {
    return stopped && restarted && changed_lane && degraded && recovered;
  }
};

[[nodiscard]] DriveContent content_of(const EpisodeResult& result);

/// Drives left turns from seed 0 on until one contains everything, and leaves its log in `file`.
/// \return the seed \throws std::runtime_error when none of the first 50 does
std::uint64_t record_reference_drive(const scenario::Scenario& left_turn, const std::filesystem::path& file);

}  // namespace s4tp::campaign
