/* From reset to main(): what the consumer's firmware has anyway. */

#include <stdint.h>
#include <stdlib.h>

int main(int argc, char** argv);
void initialise_monitor_handles(void); /* newlib: console over semihosting */
void reset(void);
extern uint32_t bss_begin[], bss_end[], stack_top[];

/* The exit code is then that of a fault. */
static void fault(void) {
  _Exit(4);
}

void reset(void) {
  volatile uint32_t* const coprocessor_access = (volatile uint32_t*)0xE000ED88;
  uint32_t* word;
  *coprocessor_access = 0xFU << 20; /* the floating-point unit */
  __asm__ volatile("dsb\n isb" ::: "memory");
  for (word = bss_begin; word < bss_end; ++word) *word = 0;
  initialise_monitor_handles();
  exit(main(0, 0));
}

static const struct {
  void* stack;
  void (*handlers[15])(void);
} vectors
    __attribute__((section(".vectors"), used)) = {stack_top, {reset, fault, fault, fault, fault, fault}};
