#include "sim_host/world/utf8.hpp"

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <string>

namespace s4tp::world {

bool is_utf8(std::string_view text) {
  static constexpr std::uint32_t kLeast[] = {0, 0x80, 0x800, 0x10000};  // by the number of bytes that follow
  for (std::size_t i = 0; i < text.size();) {
    const auto first = static_cast<unsigned char>(text[i++]);
    const int more = first < 0x80       ? 0
                     : first >> 5 == 6  ? 1
                     : first >> 4 == 14 ? 2
                     : first >> 3 == 30 ? 3
                                        : -1;
    if (more < 0) {
      return false;
    }
    std::uint32_t letter = more == 0 ? first : first & (0x3FU >> more);
    for (int k = 0; k < more; ++k, ++i) {
      if (i >= text.size() || (static_cast<unsigned char>(text[i]) >> 6) != 2) {
        return false;
      }
      letter = letter << 6 | (static_cast<unsigned char>(text[i]) & 0x3FU);
    }
    if (letter < kLeast[more] || letter > 0x10FFFF || (letter >= 0xD800 && letter < 0xE000)) {
      return false;
    }
  }
  return true;
}

void require_utf8(const std::filesystem::path& path) {
  std::string name = path.string();
  if (!is_utf8(name)) {
    std::replace_if(
        name.begin(), name.end(), [](char letter) { return static_cast<unsigned char>(letter) >= 0x80; },
        '?');
    throw std::runtime_error(
        name + ": this name is not UTF-8, and results could not hold it; please rename or link it");
  }
}

}  // namespace s4tp::world
