#pragma once
/// Tracks as sensors see real drivers: the simulator knows speeds and accelerations exactly, a recording or a
/// camera does not, and a network that was shown exact ones draws every error of them on for three seconds.

#include <cstdint>

#include "sim_host/train/sample.hpp"

namespace s4tp::train {

/// Disturbs what is seen of the others' motion, by errors that last about half a second; what they then did,
/// where they are now, the ego and its plan stay as they are.
/// \param level  0: nothing changes; 1: as rough as the roughest recordings of docs/recorded_clips.md (speeds
/// off by 0.6 m/s, accelerations by 1.4 m/s^2) \param seed  the same errors for the
/// same seed
void roughen_tracks(double level, std::uint64_t seed, satp::NetworkInput& input);

}  // namespace s4tp::train
