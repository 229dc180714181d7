#pragma once
/// Where telemetry records go: plain structs, by kind. The receiver copies; the call never blocks.

#include <cstdint>

namespace s4tp::hal {

class Telemetry {
 public:
  /// \return false when the record was dropped (and counted by the receiver)
  virtual bool publish(std::uint16_t kind, const void* record, std::uint32_t size) = 0;

 protected:
  ~Telemetry() = default;
};

}  // namespace s4tp::hal
