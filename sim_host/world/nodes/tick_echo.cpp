#include "sim_host/world/nodes/tick_echo.hpp"

#include "firmware/wire/codec.hpp"
#include "firmware/wire/e2e.hpp"

namespace s4tp::nodes {
namespace {

constexpr unsigned kEchoMask = 0xFFF;

}  // namespace

bool answers_tick(const wire::Frame& frame, unsigned tick, unsigned oldest, bool first) {
  wire::Command command;
  if (!wire::e2e_crc_fits(frame) || !wire::decode(frame, command)) return false;
  if (first && command.tick == 0) return true;
  return ((tick - command.tick) & kEchoMask) <= oldest;
}

}  // namespace s4tp::nodes
