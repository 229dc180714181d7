#pragma once
/// Calibration of the risk threshold C_t: how much risk the traffic's own drivers take when nothing goes
/// wrong.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "algo/sadrf/presets.hpp"
#include "sim_host/world/scenario/scenario.hpp"

namespace s4tp::campaign {

struct CalibrationOptions {
  int episodes = 10;  ///< per scenario and flavour
  std::uint64_t first_seed = 0;
  double duration_s = 60.0;  ///< of each, from an empty road
  std::function<void(int)> on_episode;
};

/// R_obs(t) of one field along all drives.
struct ThresholdCell {
  sadrf::FieldPreset preset = sadrf::FieldPreset::kPaper;
  sadrf::LookAhead look_ahead = sadrf::LookAhead::kShrinking;
  std::vector<float> risks;  ///< every instant of every horizon, unordered

  /// \param share  0 .. 1 \pre risks are not empty
  [[nodiscard]] float percentile(double share) const;
};

struct Calibration {
  std::vector<ThresholdCell> cells;  ///< both presets with both look-ahead options
  int drives = 0;                    ///< vehicles watched
  int left_out = 0;                  ///< of them: touched somebody
};

[[nodiscard]] Calibration empty_calibration();

/// Adds the drives of one scenario's built-in traffic. Every second each driver is put in our place: its own
/// next 3 s are the trajectory, what the others really did are the predictions, and R_obs is taken at every
/// step of it as the planner would. Drivers who touch anybody at any time are left out.
void calibrate(const scenario::Scenario& scenario, const CalibrationOptions& options,
               Calibration& calibration);

}  // namespace s4tp::campaign
