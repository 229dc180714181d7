#pragma once
/// Where a host's long-term key comes from: a file or an environment variable that the user names. Keys are
/// never part of the project.

#include <cstdint>

#include "hal/linux/linux_can.hpp"

namespace s4tp::hal::linux_host {

inline constexpr int kAuthenticationKeyBytes = 16;  ///< AES-128

struct AuthenticationKey {
  std::uint8_t bytes[kAuthenticationKeyBytes] = {};
};

/// AUTH-030 `place` is a file, or env:NAME for an environment variable; it holds 32 hexadecimal digits and
/// nothing else but white space around them. AUTH-031 A file that anybody but its owner may read or write, a
/// key that is missing, too short, too long, not hexadecimal or all zeros is refused.
/// \return false, with a reason that names the place and never the key
[[nodiscard]] bool read_key(const char* place, AuthenticationKey& key, Reason& reason);

}  // namespace s4tp::hal::linux_host
