#include "algo/planner/explanation.hpp"

namespace s4tp::planner {

float CostBreakdown::total() const {
  return progress + speed + jerk + lateral + lane + risk;
}

}  // namespace s4tp::planner
