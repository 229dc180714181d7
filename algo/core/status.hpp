#pragma once
/// What a call of the core can answer. Requirement ids stand beside the promise; tests cite them.

#include <cstdint>

namespace s4tp {

enum class Status : std::uint8_t {
  kOk = 0,                ///< CORE-001 the promise of the call holds
  kNotInitialized = 1,    ///< CORE-002 plan() before a successful init()
  kInvalidParameter = 2,  ///< CORE-003 a parameter is outside its range; the first bad field is named
  kArithmetic = 3,    ///< CORE-004 the arithmetic self-test found another rounding, FMA or flushed denormals
  kInvalidInput = 4,  ///< CORE-005 an input is not finite or outside its documented range; the plan is a stop
                      ///< CORE-013 from our own state, the running plan's, or the last valid one; else empty
  kNoLane = 5,        ///< CORE-006 no lane under the car: only the minimum-risk manoeuvre is possible
  kNoSafePlan = 6,    ///< CORE-007 every candidate was rejected; the plan is the minimum-risk manoeuvre
  kStaleTracks = 7,   ///< CORE-008 the list of tracks cannot be used; the plan is the minimum-risk manoeuvre
};

/// \return the enumerator's name, for logs
[[nodiscard]] const char* status_name(Status status);

}  // namespace s4tp
