#pragma once
/// Run-time parameters from a TOML file: [group] field = value, names as in docs/parameters.md. In [risk]
/// also preset = "paper" or "kolekar2020" and look_ahead = "shrinking" or "fixed" (docs/risk.md).

#include <filesystem>

#include "algo/core/parameters.hpp"

namespace s4tp::campaign {

/// Fields the file does not name keep their defaults.
/// \throws std::runtime_error naming file, field, what was wrong and what is accepted
[[nodiscard]] Parameters load_parameters(const std::filesystem::path& file);

}  // namespace s4tp::campaign
