#pragma once
/// The learning curve for people (a picture) and programs (JSON).

#include <filesystem>
#include <vector>

#include "sim_host/train/curve_point.hpp"

namespace s4tp::train {

/// {"points": [{"step", "position", ...}, ...]} \throws std::runtime_error when it cannot be written
void write_curve(const std::vector<CurvePoint>& curve, const std::filesystem::path& file);

/// Loss and errors over steps, as an SVG; nothing below two points. \throws as write_curve
void draw_curve(const std::vector<CurvePoint>& curve, const std::filesystem::path& file);

}  // namespace s4tp::train
