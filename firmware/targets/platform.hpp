#pragma once
/// What an image that reads a log needs of the machine under it: semihosting on bare metal, stdio elsewhere.

#include <cstdint>

namespace s4tp::targets {

/// \return a handle, or -1
[[nodiscard]] int open_for_reading(const char* path);
/// \return bytes read; 0 at the end of the file; -1 on error
[[nodiscard]] int read(int handle, void* buffer, int size);
void print(const char* text);
/// Highest use of the stack so far [bytes]; 0 where it is not known.
[[nodiscard]] std::int32_t stack_used();
void start_counting();
/// SysTick counts, wrapping; 0 where there is none.
[[nodiscard]] std::uint32_t counts_now();

/// The image itself. \param log  path, or null \return the exit code
[[nodiscard]] int run(const char* log, bool stages);

}  // namespace s4tp::targets
