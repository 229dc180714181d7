#pragma once
/// What belongs to the running program: other programs beside it, and data. The same in a build folder and where
/// the package is installed, wherever that is.

#include <filesystem>
#include <string>
#include <vector>

namespace s4tp::processes {

/// A program of ours, in the folder of the running one.
[[nodiscard]] std::string own_program(const std::string& name);

/// PROC-047 A file or folder of ours: share/s4tp/NAME, beside the running program or in a folder above it, with links
/// resolved: a package finds its own wherever it is unpacked. \throws std::runtime_error naming what is not there
[[nodiscard]] std::filesystem::path own_data(const std::string& name);

/// Whether own_data() has it.
[[nodiscard]] bool has_own_data(const std::string& name);

/// Becomes the program. \param command  its path and its arguments
/// \throws std::runtime_error naming the program and why it cannot be started
[[noreturn]] void become(std::vector<std::string> command);

}  // namespace s4tp::processes
