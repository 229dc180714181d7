#pragma once
/// Probabilities beside what happened, as one picture.

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace s4tp::train {

/// One curve of the plot.
struct Reliability {
  std::string name;
  nlohmann::ordered_json bins;  ///< [{"count", "expected", "happened"}]
};

/// Writes an SVG: expected from left to right, happened upwards, circles by count, what is right on the diagonal.
/// \throws std::runtime_error when it cannot be written
void draw_reliability(const std::vector<Reliability>& curves, const std::filesystem::path& file);

}  // namespace s4tp::train
