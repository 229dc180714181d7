#include "algo/core/check.hpp"
#include "firmware/targets/platform.hpp"
#include "hal/mps/semihosting.hpp"
#include "hal/mps/startup.hpp"

namespace semihosting = s4tp::hal::mps::semihosting;

namespace s4tp::targets {

int open_for_reading(const char* path) {
  return semihosting::open_for_reading(path);
}
int read(int handle, void* buffer, int size) {
  return semihosting::read(handle, buffer, size);
}
void print(const char* text) {
  semihosting::print(text);
}
int stack_used() {
  return static_cast<int>(hal::mps::stack_used());
}

}  // namespace s4tp::targets

void s4tp::assertion_failed(const char* expression, const char* file, int) {
  semihosting::print("assertion failed: ");
  semihosting::print(expression);
  semihosting::print(" in ");
  semihosting::print(file);
  semihosting::print("\n");
  semihosting::exit(3);
}

extern "C" void image_main() {
  static char argument[512];
  const bool given = semihosting::command_line(argument, sizeof argument);
  semihosting::exit(s4tp::targets::run(given ? argument : nullptr));
}
