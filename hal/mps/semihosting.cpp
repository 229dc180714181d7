#include "hal/mps/semihosting.hpp"

namespace s4tp::hal::mps::semihosting {
namespace {

constexpr int kSysOpen = 0x01;
constexpr int kSysClose = 0x02;
constexpr int kSysWrite0 = 0x04;
constexpr int kSysRead = 0x06;
constexpr int kSysGetCmdline = 0x15;
constexpr int kSysExitExtended = 0x20;
constexpr std::uint32_t kApplicationExit = 0x20026;
constexpr std::uint32_t kOpenReadBinary = 1;

std::int32_t call(int operation, const void* argument) {
  register int r0 __asm__("r0") = operation;
  register const void* r1 __asm__("r1") = argument;
#if __ARM_ARCH_PROFILE == 'M'
  __asm__ volatile("bkpt 0xAB" : "+r"(r0) : "r"(r1) : "memory", "lr");
#else
  __asm__ volatile("svc 0xAB" : "+r"(r0) : "r"(r1) : "memory", "lr");  // Thumb state
#endif
  return r0;
}

std::uint32_t address(const void* pointer) {
  return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(pointer));
}

std::uint32_t length(const char* text) {
  std::uint32_t size = 0;
  while (text[size] != '\0') ++size;
  return size;
}

}  // namespace

int open_for_reading(const char* path) {
  const std::uint32_t block[3] = {address(path), kOpenReadBinary, length(path)};
  return call(kSysOpen, block);
}

int read(int handle, void* buffer, int size) {
  const std::uint32_t block[3] = {static_cast<std::uint32_t>(handle), address(buffer),
                                  static_cast<std::uint32_t>(size)};
  const std::int32_t left = call(kSysRead, block);
  return left < 0 || left > size ? -1 : size - left;
}

void close(int handle) {
  const std::uint32_t block[1] = {static_cast<std::uint32_t>(handle)};
  call(kSysClose, block);
}

void print(const char* text) {
  call(kSysWrite0, text);
}

bool command_line(char* buffer, int size) {
  std::uint32_t block[2] = {address(buffer), static_cast<std::uint32_t>(size)};
  if (call(kSysGetCmdline, block) != 0) return false;
  const char* from = buffer;
  while (*from != '\0' && *from != ' ') ++from;
  while (*from == ' ') ++from;
  char* to = buffer;
  while (*from != '\0') *to++ = *from++;
  *to = '\0';
  return to != buffer;
}

void exit(int code) {
  const std::uint32_t block[2] = {kApplicationExit, static_cast<std::uint32_t>(code)};
  for (;;) call(kSysExitExtended, block);
}

}  // namespace s4tp::hal::mps::semihosting

/// An image with a debugger says so at once: exit code 3 is a fault of the core.
extern "C" void fault_handler() {
  s4tp::hal::mps::semihosting::print("fault of the core\n");
  s4tp::hal::mps::semihosting::exit(3);
}
