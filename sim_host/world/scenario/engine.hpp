#pragma once
/// Who may simulate the traffic, by name.

#include <string>
#include <vector>

namespace s4tp::scenario {

/// kAdversary: the built-in traffic, whose drivers do to the ego the worst that the law leaves them.
enum class Engine { kBuiltin, kSumo, kAdversary };

/// "builtin", "sumo", "adversary"
[[nodiscard]] const std::vector<std::string>& engine_names();
/// \throws std::invalid_argument naming those there are
[[nodiscard]] Engine engine_of(const std::string& name);

}  // namespace s4tp::scenario
