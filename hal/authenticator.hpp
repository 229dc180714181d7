#pragma once
/// Message authentication under keys that never leave their keeper: a hardware security module, a secure
/// element, a crypto library. Nothing here allocates or throws.

#include <cstdint>

namespace s4tp::hal {

enum class KeySlot : std::uint8_t {
  kLongTerm,   ///< in the keeper from the start
  kSession,    ///< derived
  kCandidate,  ///< derived, for a session that is still to prove itself
};

inline constexpr int kCmacBytes = 16;

class Authenticator {
 public:
  /// AES-128-CMAC (RFC 4493, NIST SP 800-38B) of `bytes` under a slot's key. Bounded time; called from the
  /// control context. \return false: no key in the slot, or the keeper failed; then `mac` means nothing
  [[nodiscard]] virtual bool cmac(KeySlot slot, const std::uint8_t* bytes, std::uint32_t size,
                                  std::uint8_t (&mac)[kCmacBytes]) = 0;
  /// The slot's key becomes the CMAC of `bytes` under the long-term key. \pre slot is not kLongTerm
  [[nodiscard]] virtual bool derive(KeySlot slot, const std::uint8_t* bytes, std::uint32_t size) = 0;
  /// Bytes that nobody else can guess. \return false when there are none
  [[nodiscard]] virtual bool random(std::uint8_t* bytes, std::uint32_t size) = 0;

 protected:
  ~Authenticator() = default;
};

}  // namespace s4tp::hal
