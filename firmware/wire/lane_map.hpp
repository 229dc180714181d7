#pragma once
/// The map on the wire: lane and conflict records in numbered slots, each sent when it changes and again
/// every 5 s, and a header saying what a whole map consists of. WIRE-030 A map counts only when every slot in
/// use is there in the revision the header's digest was made of; until then the previous whole one stands and
/// ages.

#include <cstdint>

#include "firmware/wire/e2e.hpp"
#include "firmware/wire/frame.hpp"

namespace s4tp::wire {

inline constexpr int kMaxLanes = 64;
inline constexpr int kMaxLanePoints = 12;
inline constexpr int kMaxConflicts = 128;
inline constexpr std::uint8_t kNoLane = 127;

struct Lane {
  bool present = false;
  std::uint8_t kind = 0;  ///< 0 ours, 1 opposite, 2 shoulder
  bool in_junction = false;
  bool on_route = false;
  std::uint8_t point_count = 0;
  std::int8_t changes_needed = 0;  ///< > 0 to the left
  float speed_limit_mps = 0.0F;
  float width_m = 0.0F;
  float stop_line_m = -1.0F;      ///< < 0: none
  std::uint8_t signal_state = 0;  ///< reserved
  float route_remaining_m = 0.0F;
  float goal_distance_m = 0.0F;
  std::uint8_t successors[3] = {kNoLane, kNoLane, kNoLane};
  std::uint8_t left = kNoLane;
  std::uint8_t right = kNoLane;
  float x_m[kMaxLanePoints] = {};
  float y_m[kMaxLanePoints] = {};
};

struct Conflict {
  bool present = false;
  std::uint8_t first = kNoLane;
  std::uint8_t second = kNoLane;
  std::uint8_t priority = 0;  ///< 0 first yields, 1 first has priority, 2 first come
  float first_entry_m = 0.0F;
  float first_exit_m = 0.0F;
  float second_entry_m = 0.0F;
  float second_exit_m = 0.0F;
};

/// All slots; what a map node offers and what an ECU ends up with.
struct Map {
  Lane lanes[kMaxLanes];
  Conflict conflicts[kMaxConflicts];
  std::uint8_t lanes_left_out = 0;
};

/// Sends a map as changes.
class MapSender {
 public:
  /// Takes the map to be shown from now on. Slots whose encoded frames changed get a new revision and go
  /// first; a lane must keep its slot while it stays within the horizon.
  void update(const Map& map);

  /// Next frame in order of need: header and slots in use (10 Hz), changed records, then the 5 s repetition.
  /// The caller's pace sets the bus load. \param now_ms  vehicle time
  /// \return false when nothing is due
  [[nodiscard]] bool next(std::uint32_t now_ms, Frame& frame);

 private:
  static constexpr int kRecords = kMaxLanes + kMaxConflicts;
  Map map_;
  std::uint8_t revision_[kRecords] = {};
  bool dirty_[kRecords] = {};
  std::uint32_t sent_ms_[kRecords] = {};
  bool ever_sent_[kRecords] = {};
  E2eSender header_;
  std::uint8_t generation_ = 0;
  std::uint32_t header_ms_ = 0;
  bool header_ever_ = false;
  int header_part_ = 0;  ///< of the header and its two slot frames, the next one
  int record_ = -1;      ///< record being sent, -1: none
  int record_frame_ = 0;
};

/// Puts the map together.
class MapReceiver {
 public:
  /// Takes a frame of one of the map messages. \return whether a new whole map has just become available
  [[nodiscard]] bool accept(const Frame& frame);
  /// The newest whole map; meaningful once accept() has answered true.
  [[nodiscard]] const Map& map() const { return whole_; }
  /// Whether the newest header matches the whole map (it is confirmed about ten times a second).
  [[nodiscard]] bool confirmed() const { return confirmed_; }
  [[nodiscard]] std::uint16_t rejected_frames() const { return rejected_; }

 private:
  struct LaneProgress {
    std::uint8_t revision = 0xFF;
    std::uint16_t parts = 0;  ///< bit 0 header, 1 route, 2 links, 3 + i point i
  };
  struct ConflictProgress {
    std::uint8_t revision = 0xFF;
    std::uint8_t parts = 0;  ///< bit 0 first, bit 1 second
  };
  Map whole_;
  Map assembling_;
  LaneProgress lane_progress_[kMaxLanes];
  ConflictProgress conflict_progress_[kMaxConflicts];
  E2eReceiver header_;
  bool header_seen_ = false;
  bool confirmed_ = false;
  std::uint8_t generation_ = 0;
  std::uint8_t lane_count_ = 0;
  std::uint8_t conflict_count_ = 0;
  std::uint16_t digest_ = 0;
  std::uint32_t in_use_[2] = {};
  std::uint8_t halves_ = 0;
  std::uint16_t rejected_ = 0;
};

}  // namespace s4tp::wire
