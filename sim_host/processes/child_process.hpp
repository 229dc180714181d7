#pragma once
/// The ECU's side of a drive, a process or an emulated board: started and ended by the one that runs the
/// world.

#include <string>
#include <vector>

namespace s4tp::processes {

class ChildProcess {
 public:
  /// \param command  program, looked for on PATH when it is no path, and its arguments
  /// \throws std::runtime_error naming the program and why it cannot be started
  explicit ChildProcess(const std::vector<std::string>& command);
  /// PROC-040 Ends it, if it has not ended by itself; it does not outlive us either, however we end.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  [[nodiscard]] bool lives();

 private:
  int process_ = -1;
};

}  // namespace s4tp::processes
