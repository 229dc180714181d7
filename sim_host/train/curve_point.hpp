#pragma once
/// What the training tells about itself now and then.

#include <cstdint>

namespace s4tp::train {

/// One point of the learning curve; means since the point before it.
struct CurvePoint {
  std::int64_t step = 0;
  double position = 0.0;  ///< parts of the loss (loss.hpp)
  double mode = 0.0;
  double route = 0.0;
  double yields = 0.0;
  double ego = 0.0;
  double gradient = 0.0;         ///< norm before clipping
  double rate = 0.0;             ///< of Adam
  double validation = 0.0;       ///< the whole loss on the validation part, with plans
  double top_1_m = 0.0;          ///< there: mean distance of the likeliest mode
  double best_of_modes_m = 0.0;  ///< there: of the nearest mode
};

}  // namespace s4tp::train
