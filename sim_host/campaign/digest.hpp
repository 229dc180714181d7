#pragma once
/// A short name for some bytes: tells whether two campaigns were driven with the same files and program.

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace s4tp::campaign {

/// FNV-1a, 64 bits.
class Digest {
 public:
  void add(std::string_view bytes);
  /// \throws std::runtime_error naming the file
  void add_file(const std::filesystem::path& file);
  [[nodiscard]] std::string hex() const;

 private:
  std::uint64_t state_ = 0xCBF29CE484222325U;
};

/// Of the program that runs.
[[nodiscard]] std::string build_digest();

}  // namespace s4tp::campaign
