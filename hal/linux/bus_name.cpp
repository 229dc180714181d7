#include "hal/linux/bus_name.hpp"

#include <stdio.h>
#include <string.h>

#include "hal/slcan.hpp"

namespace s4tp::hal::linux_host {
namespace {

constexpr std::size_t kInterfaceNameMax = 15;
constexpr const char* kAccepted =
    "can0, vcan0, slcan:tcp:HOST:PORT, slcan:listen:HOST:PORT (or anyone:PORT), slcan:pty:PATH, "
    "slcan:tty:PATH@BAUD";

bool refuse(Reason& reason, const char* text, const char* why) {
  snprintf(reason.text, sizeof reason.text, "bus '%.40s': %s; accepted: %s", text, why, kAccepted);
  return false;
}

/// \return what follows `start` in `text`, nullptr when it does not begin so
const char* after(const char* text, const char* start) {
  const std::size_t size = strlen(start);
  return strncmp(text, start, size) == 0 ? text + size : nullptr;
}

bool copy(const char* begin, std::size_t size, char (&to)[sizeof BusName::place]) {
  if (size == 0 || size >= sizeof to) return false;
  memcpy(to, begin, size);
  to[size] = '\0';
  return true;
}

/// Decimal digits and nothing else. \return false beyond `largest`, too
bool read_number(const char* text, std::uint32_t largest, std::uint32_t& number) {
  std::uint64_t value = 0;
  int digits = 0;
  for (; text[digits] >= '0' && text[digits] <= '9' && digits < 10; ++digits) {
    value = value * 10 + static_cast<std::uint64_t>(text[digits] - '0');
  }
  number = static_cast<std::uint32_t>(value);
  return digits > 0 && text[digits] == '\0' && value <= largest;
}

/// PLACE, the last `separator`, NUMBER.
bool read_pair(const char* text, char separator, std::uint32_t largest, BusName& name,
               std::uint32_t& number) {
  const char* const at = strrchr(text, separator);
  return at != nullptr && copy(text, static_cast<std::size_t>(at - text), name.place) &&
         read_number(at + 1, largest, number);
}

bool is_interface_name(const char* text) {
  const std::size_t size = strlen(text);
  return size > 0 && size <= kInterfaceNameMax && strpbrk(text, "/: \t") == nullptr &&
         strcmp(text, ".") != 0 && strcmp(text, "..") != 0;
}

}  // namespace

bool parse_bus_name(const char* text, BusName& name, Reason& reason) {
  name = BusName{};
  std::uint32_t number = 0;
  const char* rest = nullptr;
  if ((rest = after(text, "slcan:tcp:")) != nullptr || (rest = after(text, "slcan:listen:")) != nullptr) {
    name.kind = after(text, "slcan:tcp:") != nullptr ? BusKind::kTcp : BusKind::kListen;
    if (!read_pair(rest, ':', 65535, name, number) || number == 0) {
      return refuse(reason, text, "HOST:PORT expected, port 1 to 65535");
    }
    name.port = static_cast<std::uint16_t>(number);
    return true;
  }
  if ((rest = after(text, "slcan:pty:")) != nullptr) {
    name.kind = BusKind::kPty;
    return copy(rest, strlen(rest), name.place) || refuse(reason, text, "a path expected");
  }
  if ((rest = after(text, "slcan:tty:")) != nullptr) {
    name.kind = BusKind::kTty;
    if (!read_pair(rest, '@', 0xFFFFFFFFU, name, number)) return refuse(reason, text, "PATH@BAUD expected");
    if (number < kSlcanLeastBaud) {
      return refuse(reason, text, "too slow: a 500 kbit/s bus as text needs 1000000 baud or more");
    }
    name.baud = number;
    return true;
  }
  if (!is_interface_name(text)) return refuse(reason, text, "not a name of a bus");
  return copy(text, strlen(text), name.place);
}

}  // namespace s4tp::hal::linux_host
