#pragma once
/// Why the car does what it does, in words for a passenger: "Waiting: the car from the left can be there in 3.2
/// s, we would need 4.1 s."
///
/// Vehicles are named by where they are as seen from our seat, and by their size.

#include <ostream>
#include <string>
#include <vector>

#include "sim_host/view/plan_reason.hpp"

namespace s4tp::view {

/// One sentence or two.
[[nodiscard]] std::string in_words(const campaign::CycleTrace& cycle);

/// A vehicle as a passenger would name it: "the oncoming car"; "somebody" where the track is not known.
[[nodiscard]] std::string vehicle_name(const campaign::CycleTrace& cycle, int track);

/// Plans in a row that have the same reason; words and numbers of the first of them. A reason that lasts for
/// less than 0.3 s is passed over, unless the car stops for it.
struct ReasonSpan {
  double from_s = 0.0;  ///< since the episode's start
  double to_s = 0.0;
  std::string words;
  std::string numbers;
};
[[nodiscard]] std::vector<ReasonSpan> reason_spans(const campaign::Trace& trace, double pre_roll_s);

/// All reason_spans, one after the other.
void print_reason_spans(std::ostream& out, const campaign::Trace& trace, double pre_roll_s);

}  // namespace s4tp::view
