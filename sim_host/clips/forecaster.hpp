#pragma once
/// Predictors on recorded clips, one interface: what each expects of one vehicle, without anybody's plan.

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "algo/core/config.hpp"
#include "hal/sim/memory_flash_bank.hpp"
#include "sim_host/clips/clip.hpp"

namespace s4tp::clips {

/// Steps of history a forecast may look at, the present one not counted.
inline constexpr int kPastSteps = kHistorySamples - 1;

/// places[i]: box centre at (i + 1) * kStepS after the present; the clip's frame.
struct ClipFuture {
  double probability = 1.0;
  std::array<map::Vec2, kHorizonSteps> places;
};

class Forecaster {
 public:
  virtual ~Forecaster() = default;
  /// \pre the vehicle was seen from step - kPastSteps to step; nothing later is looked at
  /// \return one to kMaxModes futures, the likeliest first
  [[nodiscard]] virtual std::vector<ClipFuture> forecast(const Clip& clip, std::size_t vehicle,
                                                         int step) const = 0;
};

/// The names make_forecaster() accepts; satp only where the build carries weights.
[[nodiscard]] const std::vector<std::string>& forecaster_names();

/// CLIP-002 constant_velocity keeps speed and heading; constant_acceleration the mean acceleration of the
/// last second, down to a standstill; constant_turn_rate the mean turn rate of it; lane_following goes along
/// the lane at constant speed, its offset kept, onto the successor of least turn; off every lane it is
/// constant_velocity. kinematic and satp are the firmware's predictors on the firmware's scene, the second
/// with the weights the build carries.
/// \throws std::invalid_argument naming those there are, or why satp has no weights
[[nodiscard]] std::unique_ptr<Forecaster> make_forecaster(const std::string& name);

/// The firmware's predictors (firmware_forecaster.cpp).
[[nodiscard]] std::unique_ptr<Forecaster> make_kinematic_forecaster();
[[nodiscard]] std::unique_ptr<Forecaster> make_satp_forecaster();
/// With another image than the build's. \throws std::invalid_argument saying why it is refused
[[nodiscard]] std::unique_ptr<Forecaster> make_satp_forecaster(
    std::unique_ptr<hal::sim::MemoryFlashBank> bank);

}  // namespace s4tp::clips
