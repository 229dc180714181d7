#pragma once
/// What traffic is like, from recorded snapshots alone and whoever simulated it: what a world is calibrated
/// on before any planner is scored in it. Egos in the snapshots do not count.

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "sim_host/metrics/gap_acceptance.hpp"
#include "sim_host/world/map/network.hpp"
#include "sim_host/world/traffic/recording.hpp"

namespace s4tp::metrics {

struct Distribution {
  std::size_t count = 0;
  double mean = 0.0;
  double p05 = 0.0;
  double p25 = 0.0;
  double p50 = 0.0;
  double p75 = 0.0;
  double p95 = 0.0;
};

/// Quantiles interpolated between the values in order: the one of share p stands at p (count - 1).
[[nodiscard]] Distribution distribution_of(std::vector<double> values);

/// Ways through a junction that yield to somebody, and lanes that end.
enum class Manoeuvre { kLeftTurn, kStraight, kRightTurn, kMerge };
[[nodiscard]] const char* manoeuvre_name(Manoeuvre manoeuvre);

/// What was seen; samples of several recordings are put together by `add`.
struct TrafficSamples {
  /// Front to front past the middle of a lane of 20 m or more, successive cars.
  std::vector<double> headways_s;
  /// Bumper to bumper over own speed, every 0.1 s in which somebody follows: on the same lane, above 3 m/s,
  /// less than 3 s behind, and within 1 m/s of the leader's speed.
  std::vector<double> following_gaps_s;
  std::vector<double> speeds_mps;  ///< every second of every car
  /// Of each driver who yields in a junction: the intervals between cars with right of way that pass the
  /// ground it has to cross, all streams together, each referred to the line by its own way from there. The
  /// first begins when it is first in line within 15 m. At a merge: see `merge_gaps`.
  std::map<Manoeuvre, std::vector<GapChoice>> choices;
  std::map<Manoeuvre, std::vector<double>> waits_s;  ///< first in line until it enters the junction
  int still_waiting = 0;           ///< at a junction for more than 60 s when the recording ended
  std::vector<double> rejected_s;  ///< each gap of them that was let pass
  std::vector<double> accepted_s;  ///< each that was taken and ended
  /// At each change of lane, towards the new follower and the new leader: bumper to bumper over the speed of
  /// the one behind.
  std::vector<double> change_lags_s;
  std::vector<double> change_leads_s;
  /// Time from the first car's leaving of shared ground to the second's entering it, where two lanes meet;
  /// below 10 s. Below 0: both were on it.
  std::vector<double> post_encroachment_s;
  int collisions = 0;  ///< pairs whose own-size boxes touched; a pair counts once
  int vehicles = 0;
  int finished = 0;         ///< gone before the recording ended
  int changes = 0;          ///< of lane
  double observed_s = 0.0;  ///< length of the recordings
  double vehicle_s = 0.0;   ///< the same, each second as often as there are cars

  void add(const TrafficSamples& other);
};

[[nodiscard]] TrafficSamples observe_traffic(const map::Network& network,
                                             std::span<const traffic::Snapshot> snapshots);

}  // namespace s4tp::metrics
