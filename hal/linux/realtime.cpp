#include "hal/linux/realtime.hpp"

#include <errno.h>
#include <stdio.h>
#include <string.h>

namespace s4tp::hal::linux_host {
namespace {

using Right = RealtimeKernel::Right;

constexpr const char* kStatus = "/proc/self/status";
constexpr int kTextSize = 4096;

const char* error_name(int error) {
  const char* const name = strerrorname_np(error);
  return name != nullptr ? name : "an unknown error";
}

/// Memory the process holds locked [KiB], 0 where the kernel does not say.
unsigned long locked_kib(RealtimeKernel& kernel) {
  char text[kTextSize];
  unsigned long kib = 0;
  if (!kernel.read(kStatus, text, kTextSize)) return 0;
  const char* const line = strstr(text, "VmLck:");
  if (line == nullptr || sscanf(line, "VmLck: %lu", &kib) != 1) return 0;
  return kib;
}

void explain_fifo(RealtimeKernel& kernel, int error, int priority, Grant& grant) {
  const std::uint64_t limit = kernel.limit(Right::kNice);
  if (error == EPERM && !kernel.has(Right::kNice)) {
    snprintf(grant.reason, sizeof grant.reason, "EPERM: no CAP_SYS_NICE, and RLIMIT_RTPRIO allows %llu",
             static_cast<unsigned long long>(limit));
    snprintf(grant.remedy, sizeof grant.remedy,
             "sudo setcap cap_sys_nice,cap_ipc_lock=ep PROGRAM; or \"USER - rtprio %d\" in "
             "/etc/security/limits.conf; or sudo chrt -f %d PROGRAM",
             priority, priority);
  } else if (error == EPERM) {
    snprintf(grant.reason, sizeof grant.reason,
             "EPERM in spite of CAP_SYS_NICE: forbidden by a container or the control group");
    snprintf(grant.remedy, sizeof grant.remedy,
             "allow sched_setscheduler in the container; give the control group a cpu.rt_runtime_us");
  } else {
    snprintf(grant.reason, sizeof grant.reason, "%s", error_name(error));
    snprintf(grant.remedy, sizeof grant.remedy, "use a kernel that schedules SCHED_FIFO");
  }
}

void explain_memory(RealtimeKernel& kernel, int error, Grant& grant) {
  const auto limit_kib = static_cast<unsigned long long>(kernel.limit(Right::kLockMemory) / 1024U);
  if (error == EPERM || error == ENOMEM) {
    snprintf(grant.reason, sizeof grant.reason, "%s: %s CAP_IPC_LOCK, and RLIMIT_MEMLOCK allows %llu KiB",
             error_name(error), kernel.has(Right::kLockMemory) ? "in spite of" : "no", limit_kib);
    snprintf(grant.remedy, sizeof grant.remedy,
             "sudo setcap cap_sys_nice,cap_ipc_lock=ep PROGRAM; or \"USER - memlock unlimited\" in "
             "/etc/security/limits.conf");
  } else {
    snprintf(grant.reason, sizeof grant.reason, "%s", error_name(error));
    snprintf(grant.remedy, sizeof grant.remedy,
             error == EAGAIN ? "free some memory" : "use a kernel that locks memory");
  }
}

}  // namespace

Grant ask_for_fifo(RealtimeKernel& kernel, const char* thread, int priority) {
  Grant grant;
  snprintf(grant.what, sizeof grant.what, "SCHED_FIFO %d for %s", priority, thread);
  const int error = kernel.set_fifo(priority);
  grant.granted = error == 0;
  if (!grant.granted) explain_fifo(kernel, error, priority, grant);
  return grant;
}

Grant ask_for_locked_memory(RealtimeKernel& kernel) {
  Grant grant;
  snprintf(grant.what, sizeof grant.what, "locked memory");
  const bool boundless =
      kernel.has(Right::kLockMemory) || kernel.limit(Right::kLockMemory) == RealtimeKernel::kUnlimited;
  const int error = kernel.lock_memory(boundless);
  if (error != 0) {
    explain_memory(kernel, error, grant);
  } else if (locked_kib(kernel) == 0) {
    snprintf(grant.reason, sizeof grant.reason, "mlockall was accepted, but VmLck in %s is 0", kStatus);
    snprintf(grant.remedy, sizeof grant.remedy, "run on Linux itself, without sandbox or sanitizer");
  } else {
    grant.granted = true;
  }
  return grant;
}

KernelPreemption read_preemption(RealtimeKernel& kernel) {
  KernelPreemption result;
  char text[kTextSize];
  const auto found = [&](Preemption model, const char* source) {
    result.model = model;
    snprintf(result.source, sizeof result.source, "%s", source);
    return result;
  };
  if (kernel.read("/sys/kernel/realtime", text, kTextSize) && text[0] == '1')
    return found(Preemption::kRealtime, "/sys/kernel/realtime");
  constexpr const char* kVersion = "/proc/version";
  if (!kernel.read(kVersion, text, kTextSize)) return found(Preemption::kUnknown, "no /proc/version");
  if (strstr(text, "PREEMPT_RT") != nullptr) return found(Preemption::kRealtime, kVersion);
  if (strstr(text, "PREEMPT_DYNAMIC") == nullptr) {
    return found(strstr(text, "PREEMPT") != nullptr ? Preemption::kFull : Preemption::kWeak, kVersion);
  }
  constexpr const char* kDebug = "/sys/kernel/debug/sched/preempt";  // none voluntary (full) lazy
  if (kernel.read(kDebug, text, kTextSize) && strchr(text, '(') != nullptr)
    return found(strstr(text, "(full)") != nullptr ? Preemption::kFull : Preemption::kWeak, kDebug);
  constexpr const char* kCommandLine = "/proc/cmdline";
  if (kernel.read(kCommandLine, text, kTextSize)) {
    const char* const option = strstr(text, "preempt=");
    if (option != nullptr)
      return found(strncmp(option, "preempt=full", 12) == 0 ? Preemption::kFull : Preemption::kWeak,
                   kCommandLine);
  }
  return found(Preemption::kUnknown, "PREEMPT_DYNAMIC, and debugfs is not readable");
}

const char* preemption_name(Preemption model) {
  static constexpr const char* kNames[] = {"real-time", "full", "none, voluntary or lazy", "unknown"};
  return kNames[static_cast<int>(model)];
}

}  // namespace s4tp::hal::linux_host
