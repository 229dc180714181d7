#pragma once
/// The ECU process, started and ended by the one that runs the world.

#include <string>
#include <vector>

namespace s4tp::processes {

class EcuChild {
 public:
  /// Starts s4tp_ecu_process from the folder of the running program. \throws std::runtime_error when it
  /// cannot
  explicit EcuChild(const std::vector<std::string>& arguments);
  /// Ends it, if it has not ended by itself.
  ~EcuChild();
  EcuChild(const EcuChild&) = delete;
  EcuChild& operator=(const EcuChild&) = delete;

  [[nodiscard]] bool lives();

 private:
  int process_ = -1;
};

}  // namespace s4tp::processes
