#pragma once
/// One predictor's error over another's on the same windows, with an interval: windows of one vehicle are alike, so that
/// vehicles are drawn, not windows.

#include "sim_host/clips/figures.hpp"

namespace s4tp::clips {

struct Ratio {
  double value = 0.0;
  double low = 0.0;  ///< 95 % of 2000 bootstrap samples lie between
  double high = 0.0;
};

/// Of the distances at 3 s. CLIP-006 The same sums give the same numbers. \pre both of the same windows, at least one
[[nodiscard]] Ratio fde_ratio(const WindowSums& of, const WindowSums& over);

}  // namespace s4tp::clips
