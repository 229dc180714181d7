#pragma once
/// Why each plan of an episode was chosen, one line a planning cycle.

#include <ostream>

#include "sim_host/campaign/trace.hpp"

namespace s4tp::view {

/// Time since entry, what the car did, what was chosen and what was rejected, costs of the chosen and the
/// runner-up, who dominated the risk.
void print_explanations(std::ostream& out, const campaign::Trace& trace, double pre_roll_s);

}  // namespace s4tp::view
