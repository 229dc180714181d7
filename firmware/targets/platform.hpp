#pragma once
/// What an image that reads a log needs of the machine under it: semihosting on bare metal, stdio elsewhere.

namespace s4tp::targets {

/// \return a handle, or -1
[[nodiscard]] int open_for_reading(const char* path);
/// \return bytes read; 0 at the end of the file; -1 on error
[[nodiscard]] int read(int handle, void* buffer, int size);
void print(const char* text);
/// Highest use of the stack so far [bytes]; 0 where it is not known.
[[nodiscard]] int stack_used();

/// The image itself. \param argument  first word of the command line, or null \return the exit code
[[nodiscard]] int run(const char* argument);

}  // namespace s4tp::targets
