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
std::int32_t stack_used() {
  return static_cast<std::int32_t>(hal::mps::stack_used());
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

void image_main() {
  s4tp::targets::start_counting();
  static char words[512];
  const char* log = nullptr;
  bool stages = false;
  if (semihosting::command_line(words, sizeof words)) {
    log = words;
    for (char* c = words; *c != '\0'; ++c) {
      if (*c != ' ') continue;
      *c = '\0';
      stages = c[1] == '-';  // --stages is the only option
    }
  }
  semihosting::exit(s4tp::targets::run(log, stages));
}
