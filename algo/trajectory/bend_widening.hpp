#pragma once
/// A lane may bend more than we can steer: our way through such a bend is wider.

#include "algo/core/parameters.hpp"
#include "algo/scene/reference_line.hpp"

namespace s4tp::trajectory {

/// Moves the samples of a line around every bend that is tighter than we can steer, as little as makes it drivable, and says
/// where (ReferenceLine::tight). \pre poses are places; headings and curvatures are not there yet, and are written over
/// \return what it took [WorkMeter's units]
int widen_tight_bends(const Parameters& parameters, scene::ReferenceLine& line);

}  // namespace s4tp::trajectory
