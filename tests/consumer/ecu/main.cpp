// The ECU application without any device: it links, and refuses to start. Authentication without a key: the same.

#include <cstdlib>

#include "algo/core/check.hpp"
#include "algo/planner/planner.hpp"
#include "firmware/ecu/ecu.hpp"
#include "firmware/secoc/authentic_can.hpp"

void s4tp::assertion_failed(const char*, const char*, int) {
  std::abort();
}

static s4tp::ecu::Ecu<s4tp::planner::Planner> ecu;

struct NoKeys final : s4tp::hal::Authenticator {
  bool cmac(s4tp::hal::KeySlot, const std::uint8_t*, std::uint32_t,
            std::uint8_t (&)[s4tp::hal::kCmacBytes]) override {
    return false;
  }
  bool derive(s4tp::hal::KeySlot, const std::uint8_t*, std::uint32_t) override { return false; }
  bool random(std::uint8_t*, std::uint32_t) override { return false; }
};
struct NoBus final : s4tp::hal::Can {
  bool receive(s4tp::hal::CanFrame&) override { return false; }
  bool send(const s4tp::hal::CanFrame&) override { return false; }
  s4tp::hal::CanState state() const override { return s4tp::hal::CanState::kDown; }
  s4tp::hal::CanCounters counters() const override { return {}; }
};
static NoKeys keys;
static NoBus bus;
static s4tp::secoc::AuthenticCan authentic(bus, keys, s4tp::secoc::End::kEcu);

int main() {
  authentic.announce();
  s4tp::hal::CanFrame frame;
  if (authentic.receive(frame) || authentic.session().has_key()) return 1;
  return ecu.init(s4tp::Parameters{}, s4tp::ecu::Ports{}) == s4tp::Status::kInvalidInput ? 0 : 1;
}
