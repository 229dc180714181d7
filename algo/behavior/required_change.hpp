#pragma once
/// A lane change that the route asks for: on the way to its last place, or waiting there. Its transitions stand in one table
/// (required_change.cpp). It is over once it is made, or once the map shows another way.
///
/// \code
///   none <----> approaching <----> waiting
///     ^------------------------------'
/// \endcode

#include "algo/behavior/transition.hpp"
#include "algo/core/manoeuvre.hpp"
#include "algo/core/parameters.hpp"
#include "algo/scene/scene.hpp"

namespace s4tp::behavior {

/// What its transitions are decided by.
struct RequiredChangeSituation {
  bool needed = false;    ///< by the lane under us
  bool stands = false;    ///< we do
  bool at_place = false;  ///< no more way is left than the change takes
};

inline constexpr int kRequiredChangeRows = 5;
extern const Transition<RequiredChange, RequiredChangeSituation> kRequiredChangeTable[kRequiredChangeRows];

[[nodiscard]] RequiredChangeSituation required_change_situation(const scene::Scene& scene,
                                                                const Parameters& parameters);

}  // namespace s4tp::behavior
