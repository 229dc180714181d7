#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "algo/core/check.hpp"
#include "firmware/targets/platform.hpp"

namespace s4tp::targets {

int open_for_reading(const char* path) {
  return ::open(path, O_RDONLY | O_CLOEXEC);
}
int read(int handle, void* buffer, int size) {
  return static_cast<int>(::read(handle, buffer, static_cast<std::size_t>(size)));
}
void print(const char* text) {
  std::fputs(text, stdout);
}
std::int32_t stack_used() {
  return 0;
}

}  // namespace s4tp::targets

void s4tp::assertion_failed(const char* expression, const char* file, int line) {
  std::fflush(stdout);
  std::fprintf(stderr, "assertion failed: %s in %s:%d\n", expression, file, line);
  std::abort();
}

int main(int argc, char** argv) {
  const bool stages = argc > 2 && std::strcmp(argv[2], "--stages") == 0;
  return s4tp::targets::run(argc > 1 ? argv[1] : nullptr, stages);
}
