#pragma once
/// Names that go into JSON and HTML have to be UTF-8.

#include <filesystem>
#include <string_view>

namespace s4tp::scenario {

/// As RFC 3629 has it, and as JSON takes it: no overlong forms, no surrogates, nothing above U+10FFFF.
[[nodiscard]] bool is_utf8(std::string_view text);

/// FILE-007 A name that results could not hold is refused before anything is driven.
/// \throws std::runtime_error with the name, its other bytes as question marks
void require_utf8(const std::filesystem::path& path);

}  // namespace s4tp::scenario
