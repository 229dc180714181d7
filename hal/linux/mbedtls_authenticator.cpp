#include "hal/linux/mbedtls_authenticator.hpp"

#include <mbedtls/cipher.h>
#include <mbedtls/cmac.h>
#include <mbedtls/platform_util.h>
#include <sys/random.h>

namespace s4tp::hal::linux_host {
namespace {

constexpr unsigned kKeyBits = 128;

}  // namespace

MbedtlsAuthenticator::MbedtlsAuthenticator(const AuthenticationKey& key) {
  for (int i = 0; i < kAuthenticationKeyBytes; ++i) keys_[0][i] = key.bytes[i];
  there_[0] = true;
}

MbedtlsAuthenticator::~MbedtlsAuthenticator() {
  mbedtls_platform_zeroize(keys_, sizeof keys_);
}

bool MbedtlsAuthenticator::cmac(KeySlot slot, const std::uint8_t* bytes, std::uint32_t size,
                                std::uint8_t (&mac)[kCmacBytes]) {
  const auto index = static_cast<unsigned>(slot);
  const mbedtls_cipher_info_t* const aes = mbedtls_cipher_info_from_type(MBEDTLS_CIPHER_AES_128_ECB);
  return there_[index] && aes != nullptr &&
         mbedtls_cipher_cmac(aes, keys_[index], kKeyBits, bytes, size, mac) == 0;
}

bool MbedtlsAuthenticator::derive(KeySlot slot, const std::uint8_t* bytes, std::uint32_t size) {
  const auto index = static_cast<unsigned>(slot);
  there_[index] = index != 0 && cmac(KeySlot::kLongTerm, bytes, size, keys_[index]);
  return there_[index];
}

bool MbedtlsAuthenticator::random(std::uint8_t* bytes, std::uint32_t size) {
  return getrandom(bytes, size, 0) == static_cast<ssize_t>(size);
}

}  // namespace s4tp::hal::linux_host
