#pragma once
/// Which messages are of which group, and how companions and nonces stand on the bus. AUTH-007 A companion
/// frame is 48 bits of MAC and 16 of freshness, and nothing else.

#include <cstdint>

#include "firmware/secoc/session.hpp"
#include "firmware/wire/frame.hpp"

namespace s4tp::secoc {

[[nodiscard]] bool is_member(std::uint32_t id);  ///< of a track list
[[nodiscard]] bool is_motion(std::uint32_t id);  ///< of the motion group
[[nodiscard]] bool is_map(std::uint32_t id);
/// Command, Motion, TrackList: a group begins with them.
[[nodiscard]] bool begins(std::uint32_t id);
/// \return false: of no group
[[nodiscard]] bool find_group(std::uint32_t id, Group& group);

/// \return whether the frame is a companion
[[nodiscard]] bool read_companion(const wire::Frame& frame, Group& group, Companion& companion);
[[nodiscard]] wire::Frame write_companion(Group group, const Companion& companion);

/// \return whether the frame is a nonce of that end, undamaged
[[nodiscard]] bool read_nonce(const wire::Frame& frame, End sender, Nonce& nonce);
[[nodiscard]] wire::Frame write_nonce(End sender, const Nonce& nonce);

}  // namespace s4tp::secoc
