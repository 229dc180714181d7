#include <errno.h>
#include <fcntl.h>
#include <linux/capability.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "hal/linux/realtime.hpp"

namespace s4tp::hal::linux_host {
namespace {

class ThisKernel final : public RealtimeKernel {
 public:
  int set_fifo(int priority) override {
    sched_param wanted{};
    wanted.sched_priority = priority;
    if (const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &wanted); error != 0)
      return error;
    // Some sandboxes accept it and do nothing.
    int policy = 0;
    sched_param is{};
    if (pthread_getschedparam(pthread_self(), &policy, &is) != 0) return errno;
    return policy == SCHED_FIFO && is.sched_priority == priority ? 0 : ENOSYS;
  }

  int lock_memory(bool future) override {
    return mlockall(MCL_CURRENT | (future ? MCL_FUTURE : 0)) == 0 ? 0 : errno;
  }

  std::uint64_t limit(Right right) override {
    rlimit limit{};
    if (getrlimit(right == Right::kNice ? RLIMIT_RTPRIO : RLIMIT_MEMLOCK, &limit) != 0) return 0;
    return limit.rlim_cur == RLIM_INFINITY ? kUnlimited : limit.rlim_cur;
  }

  bool has(Right right) override {
    __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
    __user_cap_data_struct data[_LINUX_CAPABILITY_U32S_3] = {};
    if (syscall(SYS_capget, &header, data) != 0) return false;
    const int capability = right == Right::kNice ? CAP_SYS_NICE : CAP_IPC_LOCK;
    return (data[0].effective >> capability & 1U) != 0;  // both are among the first 32
  }

  bool read(const char* path, char* text, int size) override {
    const int file = open(path, O_RDONLY | O_CLOEXEC);
    if (file < 0) return false;
    const ssize_t taken = ::read(file, text, static_cast<std::size_t>(size - 1));
    close(file);
    text[taken > 0 ? taken : 0] = '\0';
    return taken >= 0;
  }
};

ThisKernel kernel;  // has no state

}  // namespace

RealtimeKernel& this_kernel() {
  return kernel;
}

__attribute__((noinline)) void touch_stack() {
  constexpr int kBytes = 256 * 1024;
  constexpr int kPageBytes = 4096;
  char stack[kBytes];
  for (int i = 0; i < kBytes; i += kPageBytes) stack[i] = 0;
  __asm__ volatile("" : : "r"(stack) : "memory");  // or the compiler leaves it all out
}

}  // namespace s4tp::hal::linux_host
