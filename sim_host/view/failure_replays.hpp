#pragma once
/// Failures of recorded campaigns, driven again from their seeds with everything the planner thought, and
/// written as replays.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <utility>

#include "sim_host/campaign/records.hpp"

namespace s4tp::view {

struct ReplayOptions {
  std::size_t per_cell = 3;  ///< at most; those through our fault first, then by seed
  int threads = 0;           ///< 0: one per core
  std::filesystem::path scenario_root;
  const std::atomic<bool>* stop = nullptr;  ///< once true, no further one begins
};

/// Those written: file name, and what came out otherwise than recorded (changed(); empty: nothing).
struct ReplayFile {
  std::string name;
  std::string changed;
};
using Replays = std::map<std::pair<campaign::Cell, std::uint64_t>, ReplayFile>;

/// Tells how far it is on the error output. \param folder  is created where there is something to write
/// \throws std::runtime_error when a scenario cannot be loaded or a file cannot be written
[[nodiscard]] Replays write_failure_replays(const campaign::Records& records, const ReplayOptions& options,
                                            const std::filesystem::path& folder);

}  // namespace s4tp::view
