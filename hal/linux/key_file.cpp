#include "hal/linux/key_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace s4tp::hal::linux_host {
namespace {

constexpr int kDigits = 2 * kAuthenticationKeyBytes;
constexpr int kTextSize = 256;  // room for white space around the digits
constexpr char kEnvironment[] = "env:";

bool refuse(const char* place, const char* why, Reason& reason) {
  (void)std::snprintf(reason.text, sizeof reason.text, "key %.120s: %s", place, why);
  return false;
}

int value_of(char digit) {
  if (digit >= '0' && digit <= '9') return digit - '0';
  if (digit >= 'a' && digit <= 'f') return digit - 'a' + 10;
  if (digit >= 'A' && digit <= 'F') return digit - 'A' + 10;
  return -1;
}

bool is_space(char letter) {
  return letter == ' ' || letter == '\t' || letter == '\n' || letter == '\r';
}

bool parse(const char* place, const char* text, AuthenticationKey& key, Reason& reason) {
  while (is_space(*text)) ++text;
  int digits = 0;
  bool all_zero = true;
  AuthenticationKey read;
  for (; *text != '\0' && !is_space(*text); ++text, ++digits) {
    const int value = value_of(*text);
    if (value < 0) return refuse(place, "not hexadecimal digits", reason);
    if (digits >= kDigits) return refuse(place, "too long: 32 hexadecimal digits are wanted", reason);
    std::uint8_t& byte = read.bytes[digits / 2];
    byte = static_cast<std::uint8_t>(byte << 4U | value);
    all_zero = all_zero && value == 0;
  }
  while (is_space(*text)) ++text;
  if (*text != '\0') return refuse(place, "more than one word: 32 hexadecimal digits are wanted", reason);
  if (digits < kDigits) {
    char why[80];
    (void)std::snprintf(why, sizeof why, "too short: %d of 32 hexadecimal digits", digits);
    return refuse(place, why, reason);
  }
  if (all_zero) return refuse(place, "all zeros is no key", reason);
  key = read;
  return true;
}

bool read_file(const char* place, char (&text)[kTextSize], Reason& reason) {
  const int file = open(place, O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK);
  if (file < 0) return refuse(place, std::strerror(errno), reason);
  struct stat status {};
  const ssize_t size = fstat(file, &status) == 0 ? read(file, text, sizeof text - 1) : -1;
  const char* why = nullptr;
  if (status.st_mode != 0 && !S_ISREG(status.st_mode)) {
    why = "no ordinary file";
  } else if ((status.st_mode & (S_IRWXG | S_IRWXO)) != 0) {
    why = "others than its owner may use the file: chmod 600";
  } else if (size < 0) {
    why = std::strerror(errno);
  } else if (size == static_cast<ssize_t>(sizeof text - 1)) {
    why = "too long: 32 hexadecimal digits are wanted";
  } else if (std::memchr(text, '\0', static_cast<std::size_t>(size)) != nullptr) {  // not the text's end
    why = "not hexadecimal digits";
  }
  close(file);
  if (why != nullptr) return refuse(place, why, reason);
  text[size] = '\0';
  return true;
}

}  // namespace

bool read_key(const char* place, AuthenticationKey& key, Reason& reason) {
  if (std::strncmp(place, kEnvironment, sizeof kEnvironment - 1) == 0) {
    const char* const value = std::getenv(place + sizeof kEnvironment - 1);
    return value != nullptr ? parse(place, value, key, reason)
                            : refuse(place, "there is no such environment variable", reason);
  }
  char text[kTextSize];
  const bool good = read_file(place, text, reason) && parse(place, text, key, reason);
  explicit_bzero(text, sizeof text);
  return good;
}

}  // namespace s4tp::hal::linux_host
