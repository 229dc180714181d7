#pragma once
/// Files, console and exit of the machine that debugs or emulates us. Source: Arm IHI 0099 (semihosting).

#include <cstdint>

namespace s4tp::hal::mps::semihosting {

/// \return a handle, or -1
[[nodiscard]] int open_for_reading(const char* path);
/// \return bytes read; 0 at the end of the file; -1 on error
[[nodiscard]] int read(int handle, void* buffer, int size);
void close(int handle);
/// Zero-terminated text to the console.
void print(const char* text);
/// The command line after the image's name, zero terminated. \return false when there is none or it is too
/// long
[[nodiscard]] bool command_line(char* buffer, int size);
[[noreturn]] void exit(int code);

}  // namespace s4tp::hal::mps::semihosting
