#pragma once
/// What the optimizer was asked in closed-loop drives, kept in a file.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "algo/trajectory/ilqr_problem.hpp"

namespace s4tp::benchmark {

/// A start that costs less than this, as much as a millimetre of progress is worth, leaves nothing to gain.
inline constexpr float kNothingToGain = 1e-3F;

struct RecordedProblems {
  std::vector<trajectory::RefinementProblem> problems;
  std::uint32_t left_out = 0;  ///< came between them and left nothing to gain
};

/// Drives all scenarios in both flavours, seeds from 0 on, and keeps every `stride`th problem with something
/// to gain until `count` are there, as many from each scenario and flavour. \param progress  told how many
/// there are
[[nodiscard]] RecordedProblems record_problems(int count, int stride,
                                               const std::function<void(int)>& progress);

/// \throws std::runtime_error naming the file
void write_problems(const std::filesystem::path& file, const RecordedProblems& recorded);
/// \throws std::runtime_error naming the file and what is wrong: not such a file, or of another build
[[nodiscard]] RecordedProblems read_problems(const std::filesystem::path& file);

}  // namespace s4tp::benchmark
