#pragma once
/// A bus end of a process with authentication (firmware/secoc), and what is told of it.

#include <memory>
#include <ostream>
#include <string>

#include "firmware/secoc/authentic_can.hpp"
#include "hal/authenticator.hpp"
#include "hal/linux/linux_can.hpp"

namespace s4tp::processes {

using Keys = std::shared_ptr<hal::Authenticator>;  ///< null: no authentication

/// The keeper of the long-term key that a user named (hal/linux/key_file.hpp).
/// \throws std::runtime_error with the reason
[[nodiscard]] Keys open_keys(const std::string& place);

class AuthenticLink final : public hal::linux_host::LinuxCan {
 public:
  /// Both must outlive this.
  AuthenticLink(hal::linux_host::LinuxCan& below, hal::Authenticator& keys, secoc::End end)
      : below_(below), can_(below, keys, end) {}

  [[nodiscard]] bool receive(hal::CanFrame& frame) override { return can_.receive(frame); }
  [[nodiscard]] bool send(const hal::CanFrame& frame) override { return can_.send(frame); }
  [[nodiscard]] hal::CanState state() const override { return can_.state(); }
  [[nodiscard]] hal::CanCounters counters() const override { return can_.counters(); }
  [[nodiscard]] bool wait(int timeout_ms) override { return below_.wait(timeout_ms); }
  [[nodiscard]] std::uint64_t received_at_us() const override { return below_.received_at_us(); }
  [[nodiscard]] bool take_news(hal::linux_host::LinkNews& news) override { return below_.take_news(news); }
  [[nodiscard]] secoc::AuthenticCan& authentic() { return can_; }

 private:
  hal::linux_host::LinuxCan& below_;
  secoc::AuthenticCan can_;
};

/// AUTH-032 Tells when a session begins or ends, and at last how many companions were verified and refused.
class SessionTeller {
 public:
  /// \param who  begins each line
  explicit SessionTeller(std::string who) : who_(std::move(who)) {}
  void tell(std::ostream& out, const secoc::AuthenticCan& can);
  void sum_up(std::ostream& out, const secoc::AuthenticCan& can) const;

 private:
  std::string who_;
  bool live_ = false;
  std::uint32_t sessions_ = 0;
};

}  // namespace s4tp::processes
