#pragma once
/// What a driver sees of road and others at one instant: who is ahead on its way, who meets it in a
/// junction.

#include <cstddef>
#include <limits>
#include <vector>

#include "sim_host/world/map/network.hpp"

namespace s4tp::traffic {

inline constexpr int kNoCar = -1;  ///< no car's id

/// A lane of somebody's way; `start_m` is the distance from the box centre to its start (negative: behind).
struct WayPart {
  map::LaneId lane = map::kNoLane;
  double start_m = 0.0;
};

/// A car as other drivers see it; the ego is one like any other.
struct Actor {
  int id = 0;  ///< 0 is the ego
  map::LaneId lane = map::kNoLane;
  double s_m = 0.0;
  double speed_mps = 0.0;
  double length_m = 5.0;
  const map::RouteGuide* guide = nullptr;
  bool committed = false;      ///< to the junction ahead: has accepted a gap and cannot well stop any more
  double waited_s = 0.0;       ///< standing near a stop line so far
  int lets_go = kNoCar;        ///< id of somebody waiting whom it lets go first
  bool queues = false;         ///< stands behind somebody who stands before the junction
  std::vector<int> waits_for;  ///< when standing: for whom
  std::vector<WayPart> also;   ///< further lanes it is in now, changing or straying; `start_m` = -s there
  std::vector<WayPart> way;    ///< filled in by TrafficView: from its lane onwards
};

/// A conflict as seen from one of its lanes.
struct Meeting {
  map::LaneId other = map::kNoLane;
  map::Rule rule = map::Rule::kFirstCome;  ///< "first" is the lane it is seen from
  double entry_m = 0.0;
  double exit_m = 0.0;
  double other_entry_m = 0.0;
  double other_exit_m = 0.0;
  bool merging = false;  ///< both lanes lead into the same one
};

/// A lane of a way that leaves the same lane as another way; cars on it stand in the other's way up to there.
struct Sibling {
  map::LaneId lane = map::kNoLane;
  double apart_m = 0.0;
  double start_m = 0.0;  ///< from the start of the lane it is seen from
};

/// What can be known of a network beforehand.
class RoadIndex {
 public:
  explicit RoadIndex(const map::Network& network);
  [[nodiscard]] const map::Network& network() const { return network_; }
  [[nodiscard]] const map::Lane& lane(map::LaneId id) const {
    return network_.lanes[static_cast<std::size_t>(id)];
  }
  [[nodiscard]] const std::vector<Meeting>& meetings(map::LaneId id) const {
    return meetings_[static_cast<std::size_t>(id)];
  }
  [[nodiscard]] const std::vector<Sibling>& siblings(map::LaneId id) const {
    return siblings_[static_cast<std::size_t>(id)];
  }

 private:
  /// The way from a lane to the end of the junction: waiting places cut a turn in two.
  [[nodiscard]] std::vector<WayPart> way_across(map::LaneId first) const;
  void add_siblings(const std::vector<WayPart>& one, const std::vector<WayPart>& other);

  const map::Network& network_;
  std::vector<std::vector<Meeting>> meetings_;
  std::vector<std::vector<Sibling>> siblings_;
};

struct Leader {
  const Actor* actor = nullptr;
  double gap_m = std::numeric_limits<double>::infinity();  ///< bumper to bumper
  bool merging = false;                                    ///< comes from the side into the lane ahead
};

class TrafficView {
 public:
  TrafficView(const RoadIndex& road, std::vector<Actor> actors);

  [[nodiscard]] const std::vector<Actor>& actors() const { return actors_; }
  [[nodiscard]] const RoadIndex& road() const { return road_; }

  /// The way a car would take from a place.
  [[nodiscard]] std::vector<WayPart> way_from(map::LaneId lane, double s_m,
                                              const map::RouteGuide* guide) const;
  /// Nearest car ahead on a way, cars that have just turned off it and those merging into it included.
  /// \param unseen  somebody who does not count
  [[nodiscard]] Leader leader(const std::vector<WayPart>& way, int self, double length_m,
                              int unseen = kNoCar) const;
  /// Nearest car behind a place of a lane and of what leads into it; `gap_m` as with a leader.
  [[nodiscard]] Leader follower(map::LaneId lane, double s_m, int self, double length_m) const;

 private:
  struct Occupant {
    std::size_t actor = 0;
    double s_m = 0.0;
  };
  [[nodiscard]] const std::vector<Occupant>& occupants(map::LaneId lane) const {
    return occupants_[static_cast<std::size_t>(lane)];
  }
  void merging_leader(const WayPart& part, int self, int unseen, bool inside, double length_m,
                      Leader& nearest) const;

  const RoadIndex& road_;
  std::vector<Actor> actors_;
  std::vector<std::vector<Occupant>> occupants_;
};

}  // namespace s4tp::traffic
