#pragma once
/// How near a predictor comes to recorded drivers (docs/recorded_clips.md).

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <set>
#include <string>

#include "sim_host/clips/forecaster.hpp"

namespace s4tp::clips {

/// Sums over windows; figures() makes means of them.
struct WindowSums {
  int windows = 0;
  double ade_m = 0.0;  ///< of the likeliest future
  double fde_m = 0.0;
  double min_ade_m = 0.0;  ///< of the best one
  int missed = 0;          ///< no future ends within 2 m of the truth
  double nll = 0.0;
  void add(const std::vector<ClipFuture>& futures, const ClipFuture& truth);
  [[nodiscard]] nlohmann::json figures() const;
};

/// Windows in which somebody does something, too.
struct FamilySums {
  WindowSums all;
  WindowSums manoeuvre;  ///< speed changes by over 2 m/s, or heading by over 15 degrees, within the 3 s
};

/// CLIP-003 A window is 1 s of history and 3 s of future of a motor vehicle that moves a metre or more in
/// them, every 0.5 s. The same window of the same traffic, seen in several clips, counts once.
class ClipFigures {
 public:
  explicit ClipFigures(const Forecaster& forecaster) : forecaster_(forecaster) {}
  void add(const Clip& clip);
  [[nodiscard]] const std::map<std::string, FamilySums>& families() const { return families_; }

 private:
  const Forecaster& forecaster_;
  std::map<std::string, FamilySums> families_;
  std::set<std::string> seen_;
};

}  // namespace s4tp::clips
