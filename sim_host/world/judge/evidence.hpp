#pragma once
/// What the judge goes by: recorded snapshots, and from them every car's way, its zones, and who saw whom.

#include <span>
#include <vector>

#include "sim_host/world/judge/law.hpp"
#include "sim_host/world/judge/standing.hpp"

namespace s4tp::judge {

/// The lane whose strip the box centre is in: the car's own, or one beside it. A car is labelled with the
/// lane it is going to before it has crossed the line.
[[nodiscard]] map::LaneId lane_under(const map::Network& network, const traffic::CarState& car);

class Evidence {
 public:
  /// \param network  must outlive it  \param snapshots  every 0.1 s
  /// \param ego_guide  the ego's route; null: the ego is no party, as it is in the pre-roll, which the
  /// traffic does not see it in
  Evidence(const map::Network& network, std::span<const traffic::Snapshot> snapshots,
           const map::RouteGuide* ego_guide);

  [[nodiscard]] const traffic::RoadIndex& road() const { return road_; }
  [[nodiscard]] const std::vector<traffic::Snapshot>& snapshots() const {
    return snapshots_;
  }  ///< lanes driven on
  [[nodiscard]] const std::vector<Journey>& journeys() const { return journeys_; }
  [[nodiscard]] const Journey* journey_of(int id) const;  ///< null: never seen on a lane
  [[nodiscard]] std::vector<ZoneGroup> groups_of(const Journey& journey) const;

  /// \pre both were there then; the ego is the car 0
  [[nodiscard]] const traffic::CarState& state_of(int id, double time_s) const;
  [[nodiscard]] bool in_sight(int from, int to, double time_s) const;
  /// How long a car has stood without a break up to a time.
  [[nodiscard]] double stood_s(const Law& law, const Journey& journey, double time_s) const;

  /// One who enters a group when another one is on its way to, or on, one of its zones, as of `time_s`. `gone` is as it
  /// came. \pre both were there at `time_s`
  [[nodiscard]] Entry entry_of(const Law& law, const Journey& entering, const ZoneGroup& group,
                               const ZoneOnWay& zone, const Journey& other, double time_s) const;
  /// Whether one entered the group by licence of the other, at `entered_s` or at any time before from which on it could not
  /// have stopped as D1 asks; or before the other one came into the world, able to stop (LAW-005).
  [[nodiscard]] bool entered_by_licence(const Law& law, const Journey& entering, const ZoneGroup& group,
                                        const ZoneOnWay& zone, const Journey& other, double entered_s) const;
  /// The other one's way to the zone. \return none: not on its way
  [[nodiscard]] std::optional<double> other_entry_m(const ZoneOnWay& zone, const Journey& other) const;
  [[nodiscard]] std::optional<double> other_exit_m(const ZoneOnWay& zone, const Journey& other) const;

 private:
  [[nodiscard]] const traffic::Snapshot& snapshot_at(double time_s) const;

  traffic::RoadIndex road_;
  std::vector<traffic::Snapshot> snapshots_;
  std::vector<Journey> journeys_;
};

}  // namespace s4tp::judge
