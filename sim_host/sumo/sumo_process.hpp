#pragma once
/// The program `sumo` as a child that never outlives us.

#include <sys/types.h>

#include <string>
#include <thread>
#include <vector>

namespace s4tp::sumo {

/// Files that exist in memory only, so that nothing is left behind however we end.
class MemoryFile {
 public:
  explicit MemoryFile(const std::string& content = {});
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  [[nodiscard]] int descriptor() const { return descriptor_; }
  [[nodiscard]] std::string content() const;

 private:
  int descriptor_;
};

/// SUMO-001 The child ends with this object, and with our process: also when we are killed. Threads may come
/// and go meanwhile.
class Process {
 public:
  /// Starts PROGRAM (found along PATH) with `input` as its standard input.
  /// \throws std::runtime_error saying that it is missing, and where to get it
  Process(const std::string& program, const std::vector<std::string>& arguments, const std::string& input);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  [[nodiscard]] bool lives();
  /// Gives it a moment to end by itself.
  void wait_for_end();
  /// What it has said last, on one line; " " when nothing.
  [[nodiscard]] std::string last_words() const;
  [[nodiscard]] pid_t id() const { return process_; }

 private:
  MemoryFile input_;
  MemoryFile output_;
  pid_t process_ = -1;
  bool ended_ = false;
  std::jthread parent_;  ///< the kernel takes the thread that forked for the parent: here one that stays
};

}  // namespace s4tp::sumo
