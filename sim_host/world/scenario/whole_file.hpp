#pragma once
/// A small file, read at once.

#include <cstdint>
#include <filesystem>
#include <string>

namespace s4tp::scenario {

/// FILE-012 Read is an ordinary file of at most `most_bytes`; of a device or a pipe there may be no end.
/// \throws std::runtime_error naming the file and why it is not read
[[nodiscard]] std::string whole_file(const std::filesystem::path& file, std::uintmax_t most_bytes);

}  // namespace s4tp::scenario
