#pragma once
/// Names in a sentence: what an error message says is accepted.

#include <functional>
#include <string>

namespace s4tp::scenario {

/// "a, b, c". \param name_of  what of each one is its name
template <class Names, class NameOf = std::identity>
[[nodiscard]] std::string listed(const Names& names, NameOf name_of = {}) {
  std::string text;
  for (const auto& one : names) text += (text.empty() ? "" : ", ") + std::string(std::invoke(name_of, one));
  return text;
}

}  // namespace s4tp::scenario
