#pragma once
/// What stands in a file.

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace s4tp::test {

/// Empty where there is no such file.
inline std::string content(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

}  // namespace s4tp::test
