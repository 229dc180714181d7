#pragma once
/// What a TOML document may look like before the parser sees it: the parser recurses with the depth of a
/// document and takes time that grows with the square of a key's parts.

#include <string_view>

namespace s4tp::scenario {

inline constexpr int kTomlNesting = 32;             ///< brackets and braces within each other, at most
inline constexpr int kTomlKeyParts = 32;            ///< of a dotted key, at most
inline constexpr std::size_t kTomlBytes = 1 << 20;  ///< of a file, at most

/// FILE-001 A document nested deeper than kTomlNesting, or with a key of more than kTomlKeyParts parts, is
/// refused; time grows with its length only. What is no TOML may pass: the parser says so. \throws
/// std::runtime_error naming the line and what is accepted
void check_toml_shape(std::string_view text);

}  // namespace s4tp::scenario
