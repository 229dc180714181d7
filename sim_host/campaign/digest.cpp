#include "sim_host/campaign/digest.hpp"

#include <cstdio>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace s4tp::campaign {

void Digest::add(std::string_view bytes) {
  for (const char byte : bytes) {
    state_ = (state_ ^ static_cast<unsigned char>(byte)) * 0x100000001B3U;
  }
}

void Digest::add_file(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw std::runtime_error(file.string() + ": cannot be read");
  add(std::string(std::istreambuf_iterator<char>(stream), {}));
}

std::string Digest::hex() const {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(state_));
  return text;
}

std::string build_digest() {
  Digest digest;
  digest.add_file("/proc/self/exe");
  return digest.hex();
}

}  // namespace s4tp::campaign
