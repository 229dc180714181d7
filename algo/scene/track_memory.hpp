#pragma once
/// What is known of vehicles beyond the newest list: who is missing from it, and everybody's past.
///
/// \code
///   list -- take() --> tracks -- forget_lost() --> those who may still be there
/// \endcode

#include <cstdint>

#include "algo/core/bounded.hpp"
#include "algo/core/world_state.hpp"
#include "algo/scene/scene.hpp"

namespace s4tp::scene {

/// One vehicle, as it was last seen.
struct RememberedTrack {
  Track track;
  std::uint32_t seen_ms = 0;  ///< list time of that
  LaneIndex lane = kNoLaneIndex;
  bool nameless = false;  ///< its id stood twice in the list
  std::uint16_t stood_ms = 0;
  std::uint16_t known_ms = 0;
  History history;
};

/// What lists are ordered by: how far away a vehicle is, less the way by which the two can come nearer in kListLeadS [m].
/// \param relative_mps  amount of the difference of its velocity and ours
[[nodiscard]] float list_distance_m(float distance_m, float relative_mps);

class TrackMemory {
 public:
  void reset();

  /// Moves all histories on by `steps` of the grid. \pre steps >= 0
  void shift_histories(int steps);
  /// Time has jumped: nobody of now was anybody then.
  void forget_all();

  /// Takes a whole list. \param centre  of our box, at the list's time \param velocity  ours then [m/s]
  void take(const TrackList& list, std::uint32_t list_ms, Point centre, Point velocity);

  /// CORE-030 Drops who is missing from the lists of a second, or is where the newest has another vehicle. No list says
  /// that anybody has gone while there is none: without lists for a second all stay until we stand, a minute at most.
  void forget_lost(std::uint32_t time_ms, bool ego_stands);

  /// CORE-036 Of the newest list, where a vehicle that had no room is remembered for as long as a missing one.
  [[nodiscard]] KnownGround known_ground(std::uint32_t time_ms) const;

  /// Whether somebody is close ahead of the vehicle.
  [[nodiscard]] bool hindered(const Track& track) const;

  [[nodiscard]] std::uint32_t last_list_ms() const { return last_list_ms_; }
  [[nodiscard]] std::uint8_t id_clashes() const { return id_clashes_; }

  BoundedVector<RememberedTrack, kMaxTracks> tracks;

 private:
  [[nodiscard]] int find(const Track& track, std::uint32_t list_ms) const;
  [[nodiscard]] bool in_anothers_place(const RememberedTrack& missing) const;
  void drop_unseen(std::uint32_t by_ms);
  void add(const Track& track, bool nameless, std::uint32_t list_ms);
  [[nodiscard]] std::uint8_t spare_id(const TrackList& list);
  /// list_distance_m of the newest list, after coasting for so long.
  [[nodiscard]] float away_m(const Track& track, float coasted_s) const;

  KnownGround listed_;         ///< as the newest list has it
  KnownGround kept_;           ///< as far as all had room, at ...
  std::uint32_t kept_ms_ = 0;  ///< ... the last time somebody had none
  std::uint32_t last_list_ms_ = 0;
  std::uint8_t id_clashes_ = 0;
  std::uint8_t last_spare_id_ = 0;
};

/// A bounded duration, as an agent carries it: at most a minute.
[[nodiscard]] std::uint16_t bounded_ms(std::int32_t duration_ms);
/// Shifts one history by `steps` of the grid. \pre steps >= 0
void shift(History& history, int steps);

}  // namespace s4tp::scene
