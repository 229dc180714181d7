#include "hal/mps/startup.hpp"

#include "hal/mps/board.hpp"

extern "C" {
extern std::uint32_t stack_bottom[];  // the linker script's
extern std::uint32_t stack_top[];
extern std::uint32_t data_load[];
extern std::uint32_t data_begin[];
extern std::uint32_t data_end[];
extern std::uint32_t bss_begin[];
extern std::uint32_t bss_end[];
using Constructor = void (*)();
extern Constructor init_array_begin[];
extern Constructor init_array_end[];
void reset_handler();
}

namespace {

constexpr std::uint32_t kPaint = 0xA5A5A5A5U;

void paint_stack() {
  std::uint32_t* const here = static_cast<std::uint32_t*>(__builtin_frame_address(0)) - 32;
  for (volatile std::uint32_t* word = stack_bottom; word < here; ++word) *word = kPaint;
}

// noinline: the FPU must be on before the compiler may save one of its registers.
__attribute__((noinline)) [[noreturn]] void run() {
  paint_stack();
  for (Constructor* constructor = init_array_begin; constructor < init_array_end; ++constructor) {
    (*constructor)();
  }
  image_main();
  fault_handler();
  for (;;) {
  }
}

}  // namespace

#if defined(__ARM_ARCH_PROFILE) && __ARM_ARCH_PROFILE == 'M'

extern "C" void reset_handler() {
  constexpr std::uintptr_t kCpacr = 0xE000ED88;  // coprocessor access: CP10 and CP11 are the FPU
  *reinterpret_cast<volatile std::uint32_t*>(kCpacr) = 0xFU << 20;
  __asm__ volatile("dsb\n isb" ::: "memory");
  const std::uint32_t* source = data_load;
  for (volatile std::uint32_t* word = data_begin; word < data_end; ++word) *word = *source++;
  for (volatile std::uint32_t* word = bss_begin; word < bss_end; ++word) *word = 0;
  run();
}

extern "C" __attribute__((weak)) void systick_handler() {}
extern "C" __attribute__((weak)) void pendsv_handler() {}
extern "C" __attribute__((weak)) void uart1_handler() {}
extern "C" __attribute__((weak)) void nmi_handler() {
  for (;;) {
  }
}

namespace {
using Handler = void (*)();
constexpr int kInterrupts = 64;  // more than we use; a stray one beyond them cannot be enabled
struct VectorTable {
  std::uint32_t* initial_stack;
  Handler handlers[15];
  Handler interrupts[kInterrupts];
};

// Reset, NMI, hard, memory, bus, usage and secure fault; 7 to 9 reserved; SVC, debug, reserved, PendSV,
// SysTick; then the devices'.
constexpr VectorTable make_vectors() {
  VectorTable table = {
      stack_top,
      {reset_handler, nmi_handler, fault_handler, fault_handler, fault_handler, fault_handler, fault_handler,
       nullptr, nullptr, nullptr, fault_handler, fault_handler, nullptr, pendsv_handler, systick_handler},
      {}};
  for (Handler& interrupt : table.interrupts) interrupt = fault_handler;
  for (const int number : s4tp::hal::mps::kUart1Interrupts) table.interrupts[number] = uart1_handler;
  return table;
}
}  // namespace

extern "C" __attribute__((section(".vectors"), used)) constexpr VectorTable vectors = make_vectors();

#else

// In user mode the loader has put .data in its place and zeroed .bss; only our own stack is to be taken.
extern "C" __attribute__((naked, used)) void reset_handler() {
  __asm__ volatile(
      "ldr r0, =stack_top\n"
      "mov sp, r0\n"
      "b s4tp_run\n");
}
extern "C" __attribute__((used)) void s4tp_run() {
  run();
}

#endif

extern "C" __attribute__((weak)) void fault_handler() {
  for (;;) {
  }
}

namespace s4tp::hal::mps {

std::uint32_t stack_size() {
  return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(stack_top) -
                                    reinterpret_cast<std::uintptr_t>(stack_bottom));
}

std::uint32_t stack_used() {
  const volatile std::uint32_t* word = stack_bottom;
  while (word < stack_top && *word == kPaint) ++word;
  return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(stack_top) -
                                    reinterpret_cast<std::uintptr_t>(word));
}

}  // namespace s4tp::hal::mps
