#pragma once
/// Text with numbers in it.

#include <string>

namespace s4tp::scenario {

/// As printf has it. \return at most 399 characters: what is longer is cut off
[[nodiscard]] std::string format(const char* pattern, ...) __attribute__((format(printf, 1, 2)));

}  // namespace s4tp::scenario
