#pragma once
/// What the two contexts hand to each other, once a planning cycle.

#include <cstdint>

#include "algo/core/parameters.hpp"
#include "algo/planner/planner.hpp"

namespace s4tp::ecu {

/// The world at a boundary: control -> planning. `input` points into this very object.
struct Snapshot {
  planner::PlannerInput input;
  LaneMap map;
  std::uint32_t map_revision = 0;  ///< of `map`, so that an unchanged one is not converted again
  Plan running;
  Parameters parameters;
  std::uint32_t parameters_crc = 0;
};

/// What came of it: planning -> control.
struct CycleResult {
  std::uint32_t computed_ms = 0;
  std::uint32_t start_ms = 0;  ///< the boundary it was asked for
  Status status = Status::kNotInitialized;
  Plan plan;
  planner::Explanation explanation;
  std::uint32_t cycles = 0;  ///< of the cycle counter
};

/// Cost of the planning cycles so far.
struct CycleStatistics {
  std::uint32_t count = 0;
  std::uint32_t last = 0;  ///< cycle counter units
  std::uint32_t maximum = 0;
  std::uint32_t slips = 0;  ///< boundaries that found the planner still busy
};

}  // namespace s4tp::ecu
