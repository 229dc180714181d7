#pragma once
/// How much of a collision rate with SUMO's traffic is the coupling's own: drives of SUMO's driver that
/// touched nobody, replayed as an ego SUMO does not drive. Whoever touches that ego does so for no fault of
/// its own.

#include <cstdint>
#include <vector>

#include "sim_host/sumo/sumo_traffic.hpp"

namespace s4tp::sumo {

/// The ego and everybody else, every 10 ms from entry on.
struct Drive {
  std::vector<traffic::CarState> ego;
  std::vector<std::vector<traffic::CarState>> others;
  bool touched = false;
  bool arrived = false;
};

/// SUMO's own driver on the scenario's mission.
[[nodiscard]] Drive sumo_drive(const scenario::Scenario& scenario, std::uint64_t seed,
                               const std::string& driver = {});

struct Replay {
  bool touched = false;
  bool stood = false;      ///< the ego, when it was touched first
  double touched_s = 0.0;  ///< after entry
  double others_strayed_m =
      0.0;  ///< largest distance between one of the others and the same one in the drive
};

[[nodiscard]] Replay replay(const scenario::Scenario& scenario, std::uint64_t seed, const Drive& drive,
                            const EgoCoupling& coupling);

}  // namespace s4tp::sumo
