#pragma once
/// Why the car does what it does: the struct every plan carries (algo/planner/explanation.hpp), put into
/// words.
///
///   in_words     for a passenger: "Waiting: the car from the left can be here in 3.2 s, we would need 4.1
///   s." in_numbers   for an engineer: costs of chosen and runner-up, rejections by reason, risk, RSS, work
///
/// Vehicles are named by where they are as seen from our seat, and by their size.

#include <ostream>
#include <string>
#include <vector>

#include "sim_host/campaign/trace.hpp"

namespace s4tp::view {

/// What the car is about to do with a plan.
enum class Doing { kWaiting, kSettingOff, kDriving, kFaster, kSlower, kHalting, kLeft, kRight, kStopping };

/// What it does that for.
enum class Because {
  kNothing,    ///< the road is free
  kLeader,     ///< who drives ahead
  kGivingWay,  ///< somebody may be where our ways cross
  kNoRoom,     ///< we would have to stand where ways cross
  kRoadEnd,    ///< the road or lane ends
  kBehind,     ///< who comes from behind in the other lane
  kRisk,       ///< the faster way was riskier
  kBend,
  kNoLane,
  kNoSafeWay,
  kBadInput,
  kNobodySeen,
};

/// Why, without its numbers: plans with the same reason are one passage.
struct Reason {
  Doing doing = Doing::kDriving;
  Because because = Because::kNothing;
  int track = -1;  ///< id of who it is about; -1: nobody, -2: somebody we are not told of
  friend bool operator==(const Reason&, const Reason&) = default;
};
[[nodiscard]] Reason reason_of(const campaign::CycleTrace& cycle);

/// One sentence or two.
[[nodiscard]] std::string in_words(const campaign::CycleTrace& cycle);

/// A vehicle as a passenger would name it: "the oncoming car"; "somebody" where the track is not known.
[[nodiscard]] std::string vehicle_name(const campaign::CycleTrace& cycle, int track);

/// Several lines, without a newline at the end.
[[nodiscard]] std::string in_numbers(const campaign::CycleTrace& cycle);

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
