#include "sim_host/world/map/xml_values.hpp"

#include <charconv>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace s4tp::map {

std::optional<double> number_in(const std::string& text) {
  const std::size_t from = text.find_first_not_of(" \t\n\r");
  const std::size_t to = text.find_last_not_of(" \t\n\r");
  if (from == std::string::npos) {
    return std::nullopt;
  }
  const char* begin = text.data() + from + (text[from] == '+' ? 1 : 0);
  const char* end = text.data() + to + 1;
  double value = 0.0;
  const auto [rest, error] = std::from_chars(begin, end, value);
  if (error != std::errc() || rest != end || !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

std::vector<std::string> words_in(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) {
    words.push_back(word);
  }
  return words;
}

pugi::xml_document parse_xml(const std::string& file) {
  pugi::xml_document document;
  const pugi::xml_parse_result result = document.load_file(file.c_str());
  if (!result) {
    throw std::runtime_error(file + ": the file: " + result.description() + " at byte " +
                             std::to_string(result.offset));
  }
  return document;
}

}  // namespace s4tp::map
