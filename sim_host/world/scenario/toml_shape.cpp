#include "sim_host/world/scenario/toml_shape.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace s4tp::scenario {
namespace {

/// \return where the string that begins at `at` has ended; the text's end when it does not
std::size_t after_string(std::string_view text, std::size_t at) {
  const char quote = text[at];
  const std::string_view three = text.substr(at, 3);
  const bool long_one = three.size() == 3 && three[1] == quote && three[2] == quote;
  for (std::size_t i = at + (long_one ? 3 : 1); i < text.size(); ++i) {
    if (text[i] == '\\' && quote == '"') {
      ++i;
    } else if (text[i] == '\n' && !long_one) {
      return i;
    } else if (text[i] == quote && (!long_one || text.substr(i, 3) == three)) {
      return i + (long_one ? 3 : 1);
    }
  }
  return text.size();
}

[[noreturn]] void refuse(std::string_view text, std::size_t at, const std::string& what) {
  const auto begin = text.begin();
  const auto line = 1 + std::count(begin, begin + static_cast<std::ptrdiff_t>(at), '\n');
  throw std::runtime_error("line " + std::to_string(line) + ": " + what);
}

}  // namespace

void check_toml_shape(std::string_view text) {
  int depth = 0;
  int parts = 1;  // of the key, or number, that is being read
  for (std::size_t i = 0; i < text.size();) {
    const char letter = text[i];
    if (letter == '"' || letter == '\'') {
      const std::size_t end = after_string(text, i);
      // toml11 reads past the end of the text where it meets one.
      const auto beyond = [](char each) { return static_cast<unsigned char>(each) > 0x7F; };
      if (letter == '\'' && std::any_of(&text[i], text.data() + end, beyond)) {
        refuse(text, i, "letters beyond ASCII within single quotes: expected double quotes");
      }
      i = end;
      continue;
    }
    if (letter == '#') {
      i = std::min(text.find('\n', i), text.size());
      continue;
    }
    if (letter == '[' || letter == '{') {
      ++depth;
    } else if (letter == ']' || letter == '}') {
      depth = std::max(depth - 1, 0);
    }
    if (letter == '.') {
      ++parts;
    } else if (letter == '\n' || letter == '=' || letter == ',' || letter == '[' || letter == ']' ||
               letter == '{' || letter == '}') {
      parts = 1;
    }
    if (depth > kTomlNesting) {
      refuse(text, i, "nested more than " + std::to_string(kTomlNesting) + " deep");
    }
    if (parts > kTomlKeyParts) {
      refuse(text, i, "a key of more than " + std::to_string(kTomlKeyParts) + " parts");
    }
    ++i;
  }
}

}  // namespace s4tp::scenario
