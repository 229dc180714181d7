#pragma once
/// The scene of a cycle, from the ego's state, the track list and the lane map.

#include <cstdint>

#include "algo/core/status.hpp"
#include "algo/scene/scene.hpp"
#include "algo/scene/track_memory.hpp"

namespace s4tp::scene {

class LaneTable;

/// Builds scenes; its only state is the tracks' past and our own.
class SceneBuilder {
 public:
  /// Forgets every track.
  void reset();

  /// CORE-030 A list is taken up to 500 ms late, its tracks coasted along their ways. One that a fresh list lacks
  /// stays for up to 1 s, or until another track is where it would be; without lists all stay until we stand.
  /// CORE-031 The scene is a function of the calls since reset(): the same calls give the same bits. CORE-032 No
  /// input makes the scene hold a value that is not finite, or an index that is out of range. CORE-033 What we
  /// have waited counts from 15 m before a zone or a junction, and is forgotten only when that junction is left: a start is not
  /// judged by another measure than the rest of the crossing. CORE-035 No vehicle is dropped for its id: those
  /// that share one are all kept, under ids that nobody has, new ones in each list, without history; their
  /// number is told.
  /// \param list_time_ms  vehicle time of `tracks`; a list older than the last one is ignored
  /// \param map  may be null or empty: the scene then has no ego paths and the status says so
  /// \return kOk, kNoLane (the scene is still usable for a minimum-risk manoeuvre), or kInvalidInput (the ego
  /// is not finite: the scene is empty)
  [[nodiscard]] Status build(std::uint32_t time_ms, const EgoState& ego, const TrackList& tracks,
                             std::uint32_t list_time_ms, const LaneMap* map, const Parameters& parameters,
                             Scene& scene);

  Relevance relevance = Relevance::kInteraction;

 private:
  void note_waiting(std::int32_t passed_ms, const Scene& scene, const Parameters& parameters);
  void advance_time(std::uint32_t time_ms);
  void take_list(const TrackList& tracks, std::uint32_t list_time_ms, const Parameters& parameters,
                 Scene& scene);
  void add_agents(const LaneTable& table, std::int32_t passed_ms, Scene& scene);

  TrackMemory memory_;
  History ego_history_;
  std::uint32_t last_ms_ = 0;
  bool started_ = false;
  std::int32_t waited_ms_ = 0;
  LaneIndex ego_lane_ = kNoLaneIndex;
  bool in_junction_ = false;  ///< we are
};

}  // namespace s4tp::scene
