#include "sim_host/world/scenario/utf8.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

namespace s4tp::scenario {

bool is_utf8(std::string_view text) {
  try {
    (void)nlohmann::json(text).dump();
    return true;
  } catch (const nlohmann::json::type_error&) {
    return false;
  }
}

void require_utf8(const std::filesystem::path& path) {
  std::string name = path.string();
  if (is_utf8(name)) return;
  std::replace_if(
      name.begin(), name.end(), [](char letter) { return static_cast<unsigned char>(letter) >= 0x80; }, '?');
  throw std::runtime_error(
      name + ": this name is not UTF-8, and results could not hold it; please rename or link it");
}

}  // namespace s4tp::scenario
