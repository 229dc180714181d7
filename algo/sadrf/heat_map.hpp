#pragma once
/// The picture of the risk shown to people: what the others perceive, summed over the horizon, with the cost map
/// laid over it. Computed in idle time when somebody subscribes; nothing in the plan depends on it.
///
/// \code
///   row 63  +--------------------------------+   y = +32 m, left
///           |       ego at the cross         |
///           |       +===>                    |   cells of 1 m in the frame of our rear axle
///   row 0   +--------------------------------+   y = -32 m
///     column 0                         column 127: x = -32 .. 96 m
/// \endcode
/// Source: method.md 3.

#include <cstdint>

#include "algo/core/parameters.hpp"
#include "algo/sadrf/drivable.hpp"
#include "algo/satp/prediction.hpp"
#include "algo/scene/scene.hpp"

namespace s4tp::sadrf {

inline constexpr int kHeatColumns = 128;  ///< 1 m each, ahead
inline constexpr int kHeatRows = 64;      ///< 1 m each, to the left
inline constexpr int kHeatBehind = 32;    ///< columns behind our rear axle

/// Levels of a cell: risk 0 .. kHeatHighest, or what the cost map has there.
inline constexpr std::uint8_t kHeatHighest = 239;
inline constexpr std::uint8_t kHeatOffRoad = 240;
inline constexpr std::uint8_t kHeatOpposite = 241;
inline constexpr std::uint8_t kHeatVehicle = 255;
/// The field summed over vehicles and time [risk unit * s] that gives kHeatHighest; the level is its root, so
/// that weak risk shows.
inline constexpr float kHeatFullScale = 20.0F;

struct HeatMap {
  std::uint8_t cells[kHeatRows][kHeatColumns] = {};
};

/// CORE-064 One row, so that idle time can be left after each: vehicles (where they cover half a cell) over
/// risk over ground. \pre 0 <= row < kHeatRows Work: kHeatColumns * (kMaxAgents * kMaxModes + kMaxTracks) *
/// 10 points of a field at most.
void heat_row(const scene::Scene& scene, const DrivableArea& area, const satp::PredictionSet& prediction,
              const satp::KinematicSet& others, const Parameters& parameters, int row, HeatMap& map);

}  // namespace s4tp::sadrf
