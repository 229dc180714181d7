#pragma once
/// Whose fault a collision is, from what was recorded and the rules of the road alone.
///
/// First row that fits; "ours" when in doubt. "Lately" is 3 s.
/// | id        | situation                                                      | fault | cause |
/// |-----------|----------------------------------------------------------------|-------|----------------------------|
/// | WORLD-040 | ways through a junction cross or merge, we had to yield        | ours  | entered without
/// priority   | | WORLD-041 | the same, he had to yield                                      | his   | failed
/// to yield to us      | | WORLD-042 | the same, first come: the later one inside                     | later
/// | entered after the other    | | WORLD-043 | one behind the other, we in front, in his lane only lately |
/// ours  | cut in                     | | WORLD-044 | the same, but we stand in a live lane without reason |
/// ours  | stopped in a live lane     | | WORLD-045 | the same, otherwise | his   | rear-ended by | |
/// WORLD-046 | one behind the other, he in front, in our lane only lately     | his   | cut in by | |
/// WORLD-047 | the same, otherwise                                            | ours  | ran into | |
/// WORLD-048 | side by side, he over the line or lately changed lane, we not  | his   | changed lane into us
/// | | WORLD-049 | side by side, otherwise                                        | ours  | changed lane into
/// |

#include <vector>

#include "sim_host/world/network.hpp"
#include "sim_host/world/recording.hpp"

namespace s4tp::world {

struct Verdict {
  Fault fault = Fault::kNone;
  std::string cause;
};

/// \param history  snapshots up to and including the touch
[[nodiscard]] Verdict attribute(const Network& network, const std::vector<Snapshot>& history, int other);

}  // namespace s4tp::world
