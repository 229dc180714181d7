#include "sim_host/world/scenario/whole_file.hpp"

#include <fstream>
#include <iterator>
#include <stdexcept>
#include <system_error>

namespace s4tp::scenario {

namespace fs = std::filesystem;

std::string whole_file(const fs::path& file, std::uintmax_t most_bytes) {
  const auto refuse = [&](const std::string& why) { throw std::runtime_error(file.string() + ": " + why); };
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (status.type() == fs::file_type::not_found) refuse("there is no such file");
  if (!fs::is_regular_file(status)) refuse(error ? error.message() : "is no ordinary file");
  if (fs::file_size(file) > most_bytes) refuse("longer than " + std::to_string(most_bytes) + " bytes");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) refuse("cannot be read");
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace s4tp::scenario
