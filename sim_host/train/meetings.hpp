#pragma once
/// Who came first where two ways meet: read off what happened, for the labels of training samples.

#include <cstdint>
#include <span>
#include <vector>

#include "sim_host/train/sample.hpp"
#include "sim_host/world/judge/journey.hpp"
#include "sim_host/world/map/network.hpp"
#include "sim_host/world/traffic/recording.hpp"

namespace s4tp::train {

/// What became of the ego and one other car.
struct Meeting {
  bool shares = false;                    ///< a lane or a zone of their ways is the same
  SampleRule rule = SampleRule::kNoZone;  ///< at the first zone both ways have and neither has passed
  std::int8_t yields = -1;  ///< 1: it came after the ego; 0: before; -1: no zone, or not settled
  double entry_s = 0.0;     ///< when the ego entered that zone; infinity: not seen
};

/// TRAIN-010 A zone's order counts as settled once one of the two has left it and the other has not entered
/// it, or has entered it later; where both are in a crossing at once, who left first was first, in a merge
/// who entered first. Ways go on beyond what was seen as far as there is only one (the ego's: its route).
class Meetings {
 public:
  /// \param drive  snapshots from the sample's instant on, at least one  \param guide  the ego's
  Meetings(const map::Network& network, const map::RouteGuide& guide,
           std::span<const traffic::Snapshot> drive);
  [[nodiscard]] Meeting with(int car) const;

 private:
  const map::Network& network_;
  std::vector<judge::Journey> journeys_;
  std::size_t ego_ = 0;  ///< index; beyond the last: off the network
};

}  // namespace s4tp::train
