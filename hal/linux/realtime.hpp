#pragma once
/// What a program asks of Linux to be on time, and what to do where it is not given.

#include <cstdint>

namespace s4tp::hal::linux_host {

/// The kernel, as far as being on time goes. A test answers in its place.
class RealtimeKernel {
 public:
  enum class Right : std::uint8_t { kNice, kLockMemory };  ///< CAP_SYS_NICE, CAP_IPC_LOCK
  static constexpr std::uint64_t kUnlimited = UINT64_MAX;

  /// SCHED_FIFO for the calling thread. \return 0 or errno
  [[nodiscard]] virtual int set_fifo(int priority) = 0;
  /// mlockall. \param future  also what is allocated later. \return 0 or errno
  [[nodiscard]] virtual int lock_memory(bool future) = 0;
  /// The soft limit that stands in for a right: RLIMIT_RTPRIO, RLIMIT_MEMLOCK [bytes].
  [[nodiscard]] virtual std::uint64_t limit(Right right) = 0;
  [[nodiscard]] virtual bool has(Right right) = 0;
  /// A file's beginning, ended by 0. \return false when it cannot be read
  [[nodiscard]] virtual bool read(const char* path, char* text, int size) = 0;

 protected:
  ~RealtimeKernel() = default;
};

/// The one this program runs on.
[[nodiscard]] RealtimeKernel& this_kernel();

/// How a request went. RT-010 A refusal names the error, its reason, and what to do about it.
struct Grant {
  char what[48] = {};
  bool granted = false;
  char reason[160] = {};  ///< of a refusal
  char remedy[160] = {};
};

/// SCHED_FIFO for the calling thread.
[[nodiscard]] Grant ask_for_fifo(RealtimeKernel& kernel, const char* thread, int priority);

/// All memory the process has locked, and what it allocates later, too, where no limit could then make an
/// allocation fail. To be called when threads and buffers are there.
[[nodiscard]] Grant ask_for_locked_memory(RealtimeKernel& kernel);

/// Touches the stack the calling thread is going to use, so that no page of it is missing later.
void touch_stack();

/// How soon the kernel lets go of a processor that a thread of higher priority wants.
enum class Preemption : std::uint8_t {
  kRealtime,  ///< PREEMPT_RT
  kFull,      ///< anywhere but under its spin locks
  kWeak,      ///< none, voluntary or lazy
  kUnknown,   ///< chosen when it was started, and not readable
};

struct KernelPreemption {
  Preemption model = Preemption::kUnknown;
  char source[96] = {};  ///< what it was read from
};

/// RT-011 From /sys/kernel/realtime, the kernel's version line, and where that says PREEMPT_DYNAMIC, from
/// debugfs or the kernel's command line.
[[nodiscard]] KernelPreemption read_preemption(RealtimeKernel& kernel);
[[nodiscard]] const char* preemption_name(Preemption model);

}  // namespace s4tp::hal::linux_host
