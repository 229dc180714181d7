#pragma once
/// Resets the processor when it is not kicked in time.

namespace s4tp::hal {

class Watchdog {
 public:
  virtual void kick() = 0;

 protected:
  ~Watchdog() = default;
};

}  // namespace s4tp::hal
