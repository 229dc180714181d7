#pragma once
/// How near a predictor comes to recorded drivers (docs/recorded_clips.md).

#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "sim_host/clips/forecaster.hpp"
#include "sim_host/clips/windows.hpp"

namespace s4tp::clips {

/// Sums over windows; figures() makes means of them.
struct WindowSums {
  int windows = 0;
  double ade_m = 0.0;  ///< of the likeliest future
  double fde_m = 0.0;
  double min_ade_m = 0.0;  ///< of the best one
  int missed = 0;          ///< no future ends within 2 m of the truth
  double nll = 0.0;
  std::map<std::uint64_t, double> fde_by_vehicle_m;  ///< its part of fde_m (vehicle_number)
  void add(std::uint64_t vehicle, const std::vector<ClipFuture>& futures, const ClipFuture& truth);
  [[nodiscard]] nlohmann::json figures() const;
};

/// Windows in which somebody does something, too.
struct FamilySums {
  WindowSums all;
  WindowSums manoeuvre;  ///< speed changes by over 2 m/s, or heading by over 15 degrees, within the 3 s
};

/// Over all windows (windows.hpp).
class ClipFigures {
 public:
  /// \param kept_only  of vehicles only that no training takes (kept_for_judging)
  explicit ClipFigures(const Forecaster& forecaster, bool kept_only = false)
      : forecaster_(forecaster), kept_only_(kept_only) {}
  void add(const Clip& clip);
  [[nodiscard]] const std::map<std::string, FamilySums>& families() const { return families_; }

 private:
  const Forecaster& forecaster_;
  std::map<std::string, FamilySums> families_;
  bool kept_only_;
  Windows windows_;
};

}  // namespace s4tp::clips
