#include "firmware/wire/version.hpp"

#include "firmware/wire/codec.hpp"

namespace s4tp::wire {

std::uint8_t wire_version() {
  return kWireVersion;
}
std::uint32_t layout_hash() {
  return kLayoutHash;
}

}  // namespace s4tp::wire
