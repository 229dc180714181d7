#pragma once
/// The driving risk field over speed and steering, as a grid of heat maps.

#include <filesystem>

#include "algo/sadrf/presets.hpp"

namespace s4tp::view {

/// Rows: speeds; columns: road-wheel angles; all panels to one scale. \throws std::runtime_error naming the
/// file
void draw_field_grid(sadrf::FieldPreset preset, const std::filesystem::path& file);

}  // namespace s4tp::view
