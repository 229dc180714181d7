#pragma once
/// The windows of recorded traffic that predictors are measured on and trained with.

#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include "sim_host/clips/clip.hpp"

namespace s4tp::clips {

struct Window {
  std::size_t vehicle;  ///< index
  int step;             ///< the present
};

/// CLIP-003 A window is 1 s of history and 3 s of future of a motor vehicle that moves a metre or more in
/// them, every 0.5 s. The same window of the same traffic, seen in several clips, counts once.
class Windows {
 public:
  /// Those of a clip that no clip before has shown.
  [[nodiscard]] std::vector<Window> of(const Clip& clip);

 private:
  std::set<std::string> seen_;
};

/// A number of a recorded vehicle, the same in every clip that shows it.
[[nodiscard]] std::uint64_t vehicle_number(const std::string& family, const std::string& id);

/// CLIP-004 One vehicle of five is never trained with, in whatever clip it is seen.
[[nodiscard]] bool kept_for_judging(const std::string& family, const std::string& id);

}  // namespace s4tp::clips
