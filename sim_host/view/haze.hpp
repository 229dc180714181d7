#pragma once
/// The driving risk fields of the cars around, summed: where they are about to be.

#include <string>
#include <vector>

#include "algo/sadrf/field.hpp"
#include "sim_host/world/traffic/recording.hpp"

namespace s4tp::view {

/// How deep a picture of risk is painted, as letters: "a" nothing to "p" deepest.
inline constexpr int kDeepest = 15;
/// A letter a cell, and before it how often it comes when that is more than once. Empty: "a" everywhere.
[[nodiscard]] std::string in_runs(const std::string& letters);

/// Of true states, so whoever drives the ego has one. Every car keeps its speed and its turn.
class Haze {
 public:
  /// \param origin  near the cars, network coordinates
  Haze(const std::vector<traffic::CarState>& cars, map::Vec2 origin);

  /// How deep to paint a place: 0 nothing .. 1, the root of the risk so that faint parts show.
  [[nodiscard]] double at(map::Vec2 point) const;

  /// The same on a grid of square cells as text: in_runs(), row by row from the lowest.
  [[nodiscard]] std::string grid(map::Vec2 low, map::Vec2 high, double cell_m) const;

 private:
  map::Vec2 origin_;
  std::vector<sadrf::Field> fields_;
};

}  // namespace s4tp::view
