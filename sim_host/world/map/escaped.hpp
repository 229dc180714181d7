#pragma once
/// Text in XML and HTML.

#include <string>

namespace s4tp::map {

/// For text and for attributes in double quotes.
[[nodiscard]] std::string escaped(const std::string& text);

}  // namespace s4tp::map
