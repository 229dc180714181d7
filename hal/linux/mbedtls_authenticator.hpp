#pragma once
/// The keys' keeper of a host: mbedTLS in this process's memory, and the kernel's random numbers. Whoever can
/// read the process's memory has the key; on a vehicle its place is in hardware.

#include <cstdint>

#include "hal/authenticator.hpp"
#include "hal/linux/key_file.hpp"

namespace s4tp::hal::linux_host {

class MbedtlsAuthenticator final : public Authenticator {
 public:
  explicit MbedtlsAuthenticator(const AuthenticationKey& key);
  ~MbedtlsAuthenticator();
  MbedtlsAuthenticator(const MbedtlsAuthenticator&) = delete;
  MbedtlsAuthenticator& operator=(const MbedtlsAuthenticator&) = delete;

  [[nodiscard]] bool cmac(KeySlot slot, const std::uint8_t* bytes, std::uint32_t size,
                          std::uint8_t (&mac)[kCmacBytes]) override;
  [[nodiscard]] bool derive(KeySlot slot, const std::uint8_t* bytes, std::uint32_t size) override;
  [[nodiscard]] bool random(std::uint8_t* bytes, std::uint32_t size) override;

 private:
  static constexpr int kSlots = 3;
  std::uint8_t keys_[kSlots][kAuthenticationKeyBytes] = {};
  bool there_[kSlots] = {};
};

}  // namespace s4tp::hal::linux_host
