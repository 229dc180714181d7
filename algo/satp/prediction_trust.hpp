#pragma once
/// How far the network is trusted about each vehicle: its own last predictions, held against what came.
///
/// A vehicle that is driven unlike anything the training knew is predicted badly half a second ahead already:
/// that shows before it matters at three seconds. SATP-050 A vehicle predicted as well as usual is trusted
/// fully; one that was off by three times the usual error or more loses half of its trust each time, and wins
/// it back as fast. SATP-051 Trust belongs to tracks; a new one is trusted.

#include <cstdint>

#include "algo/core/bounded.hpp"
#include "algo/satp/prediction.hpp"
#include "algo/scene/scene.hpp"

namespace s4tp::satp {

class PredictionTrust {
 public:
  void reset() { tracks_.clear(); }

  /// Holds due predictions against the scene. \param usual_residual_m  WeightHeader::usual_residual_m
  void observe(const scene::Scene& scene, float usual_residual_m);
  /// Remembers what is predicted of the watched vehicles. \param start_ms  plan start, the predictions' time
  /// zero
  void remember(const scene::Scene& scene, const PredictionSet& prediction, std::uint32_t start_ms);

  /// \return 0 .. 1
  [[nodiscard]] float of(std::uint8_t track) const;

 private:
  struct Entry {
    std::uint8_t track = 255;
    float trust = 1.0F;
    std::uint32_t due_ms = 0;
    BoundedVector<Point, kMaxModes> expected;  ///< one a mode; none: nothing is due
  };
  [[nodiscard]] int find(std::uint8_t track) const;

  BoundedVector<Entry, kMaxAgents> tracks_;
};

}  // namespace s4tp::satp
