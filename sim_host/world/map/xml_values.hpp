#pragma once
/// Values of XML attributes, strictly read.

#include <optional>
#include <pugixml.hpp>
#include <string>
#include <vector>

namespace s4tp::map {

/// The whole text as a finite number.
[[nodiscard]] std::optional<double> number_in(const std::string& text);
/// Split at white space.
[[nodiscard]] std::vector<std::string> words_in(const std::string& text);

/// \throws std::runtime_error naming file and byte
[[nodiscard]] pugi::xml_document parse_xml(const std::string& file);

}  // namespace s4tp::map
