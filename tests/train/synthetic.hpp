#pragma once
/// Traffic by rule, for tests of the training: what can be learned from it is known.

#include <cstdint>
#include <filesystem>

#include "sim_host/train/sample_file.hpp"

namespace s4tp::train {

/// Two vehicles a scene, on roads numbered 0 .. roads - 1, `each` instants a road.
/// - Vehicle 0 turns at its own constant rate, as its history shows.
/// - Vehicle 1 drives straight towards a zone it shares with us, 4 .. 16 m/s. If our plan passes the zone (we
/// go),
///   it brakes at 3 m/s^2; if we wait, it keeps its speed. Nothing but the plan tells. Both plans are there,
///   as branches of one fork.
void write_rule_traffic(const std::filesystem::path& file, std::uint64_t seed, int roads, int each);

}  // namespace s4tp::train
