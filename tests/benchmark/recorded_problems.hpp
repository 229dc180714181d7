#pragma once
/// What the optimizer was asked in closed-loop drives, kept in a file.

#include <cstdint>
#include <filesystem>
#include <vector>

#include "algo/trajectory/ilqr_problem.hpp"

namespace s4tp::benchmark {

/// Drives all scenarios in both flavours, seeds from 0 on, and keeps every `stride`th problem until `count`
/// are there.
[[nodiscard]] std::vector<RefinementProblem> record_problems(int count, int stride);

/// \throws std::runtime_error naming the file
void write_problems(const std::filesystem::path& file, const std::vector<RefinementProblem>& problems);
/// \throws std::runtime_error naming the file and what is wrong: not such a file, or of another build
[[nodiscard]] std::vector<RefinementProblem> read_problems(const std::filesystem::path& file);

}  // namespace s4tp::benchmark
