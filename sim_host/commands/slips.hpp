#pragma once
/// What to say to who mistyped a command or an option: what is wrong, and what was probably meant.

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace s4tp::commands {

/// What to try first.
[[nodiscard]] std::string first_steps();

/// Of `known` the one nearest to `word` in letters changed, left out, added or exchanged: at most two, and no
/// more than a third of the word. \return empty: none is near
[[nodiscard]] std::string nearest(const std::string& word, const std::vector<std::string>& known);

/// \param word  the first one given \return empty: it is a command, or an option
[[nodiscard]] std::string wrong_command(const CLI::App& tool, const std::string& word);

/// \return what to say of arguments that no command takes \pre there are some
[[nodiscard]] std::string wrong_arguments(const CLI::App& tool);

}  // namespace s4tp::commands
