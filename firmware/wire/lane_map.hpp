#pragma once
/// The map on the wire: lane and conflict records in numbered slots, each sent when it changes and again
/// every 5 s, and a header saying what a whole map consists of. WIRE-030 A map counts only when every slot in
/// use holds the record the header's digest was made of; until then the previous whole one stands and ages.
///
/// Lane slots in use are listed in two bit fields. Conflict slots are in use from 0 up to the last one
/// present; a hole among them travels as a record of lane 0 with itself. The digest is the sum of the checks
/// (crc16.hpp) of all frames of the records in use, each of which says its slot: a record left over from 16
/// revisions ago has the right revision, but not the right content.
///
/// WIRE-036 Each half of the slots also says a digest over the revisions of its records in use: records of
/// two maps, each whole, do not pass for one by a chance of 1 in 65,536 that their sums agree.

#include <cstdint>

#include "firmware/wire/e2e.hpp"
#include "firmware/wire/frame.hpp"

namespace s4tp::wire {

inline constexpr int kMaxLanes = 64;
inline constexpr int kMaxLanePoints = 12;
inline constexpr int kMaxConflicts = 128;
inline constexpr std::uint8_t kNoLane = 127;
inline constexpr int kMaxLaneParts = 3 + kMaxLanePoints;  ///< frames: header, route, links, points
inline constexpr int kConflictParts = 2;

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
///
/// WIRE-031 The largest map is whole at the other end within 1.5 s of the start at a pace of 10 frames every
/// 10 ms; with 6 points a lane 8 frames will do.
/// WIRE-032 Every record goes out again within 5 s, spread evenly.
class MapSender {
 public:
  /// Takes the map to be shown from now on. Slots whose encoded frames changed get a new revision and go
  /// first; a lane must keep its slot while it stays within the horizon.
  /// WIRE-033 What the receiver would refuse is not sent: a lane with a value the wire cannot carry or with
  /// fewer than two points is left out and counted, links to absent lanes become kNoLane, conflicts of absent
  /// lanes or with entry behind exit become absent.
  void update(const Map& map);

  /// Next frame in order of need: header and slots in use (10 Hz), changed records, then the 5 s repetition.
  /// The caller's pace sets the bus load. \param now_ms  vehicle time
  /// \return false when nothing is due
  [[nodiscard]] bool next(std::uint32_t now_ms, Frame& frame);

 private:
  static constexpr int kRecords = kMaxLanes + kMaxConflicts;  ///< lanes first

  /// How far a record got.
  struct Progress {
    std::uint8_t revision = 0;
    bool changed = false;  ///< since it was last sent whole
    std::uint16_t check = 0;
    std::uint32_t sent_ms = 0;
  };

  [[nodiscard]] bool in_use(int record) const;
  [[nodiscard]] int frame_count(int record) const;
  [[nodiscard]] bool encode_part(int record, int part, Frame& frame) const;
  [[nodiscard]] bool take_lanes(const Map& map);
  [[nodiscard]] bool take_conflicts(const Map& map);
  void revise(int record);
  void make_digest();
  [[nodiscard]] std::uint16_t revisions(int half) const;
  [[nodiscard]] bool header_frame(std::uint32_t now_ms, Frame& frame);
  [[nodiscard]] int choose_record(std::uint32_t now_ms);

  Map map_;
  bool started_ = false;
  Progress progress_[kRecords];
  std::uint32_t lanes_in_use_[2] = {};
  int lane_count_ = 0;
  int conflict_count_ = 0;
  std::uint16_t digest_ = 0;
  E2eSender header_;
  std::uint8_t generation_ = 0;
  std::uint32_t header_ms_ = 0;
  bool header_sent_ = false;
  int header_part_ = 0;  ///< of the header and its two slot frames, the next one
  int record_ = -1;      ///< record being sent, -1: none
  int record_part_ = 0;
  std::uint32_t repeated_ms_ = 0;  ///< when the latest repetition was due
};

/// Puts the map together. WIRE-035 A frame changes the digest by what it changes itself: a burst costs no
/// more for the size of the map.
class MapReceiver {
 public:
  /// Takes a frame of one of the map messages. \return whether a new whole map has just become available
  [[nodiscard]] bool accept(const Frame& frame);
  /// WIRE-034 To be called when a period (100 ms) ended without a header: the map is no longer confirmed.
  void nothing_arrived();
  /// The newest whole map; meaningful once accept() has answered true.
  [[nodiscard]] const Map& map() const { return whole_; }
  /// Whether the newest header matches the whole map (it is confirmed about ten times a second).
  [[nodiscard]] bool confirmed() const { return confirmed_; }
  [[nodiscard]] std::uint16_t rejected_frames() const { return rejected_; }

 private:
  template <int Parts>
  struct Progress {
    std::uint8_t revision = 0xFF;
    std::uint16_t parts = 0;  ///< bit i: part i arrived
    std::uint16_t checks[Parts] = {};

    [[nodiscard]] bool has(int count) const;
    /// Clears parts and record when the revision is another one. \return whether it is
    template <typename Record>
    [[nodiscard]] bool open(std::uint8_t new_revision, Record& record);
    void note(int part, const Frame& frame);
    /// What a record of `count` parts adds to the digest, as far as it is there.
    [[nodiscard]] std::uint16_t check(int count) const;
  };

  /// What a header says a whole map is.
  struct Announced {
    std::uint8_t lane_count = 0;
    std::uint8_t conflict_count = 0;
    std::uint8_t lanes_left_out = 0;
    std::uint16_t digest = 0;
    [[nodiscard]] bool same(const Announced& other) const;
  };

  [[nodiscard]] bool accept_header(const Frame& frame);
  [[nodiscard]] bool accept_slots(const Frame& frame);
  template <typename Message>
  [[nodiscard]] bool accept_lane_part(const Frame& frame);
  template <typename Message>
  [[nodiscard]] bool accept_conflict_part(const Frame& frame);
  // A part's way in: what does not depend on its message.
  void open_lane(int slot, std::uint8_t revision);
  [[nodiscard]] std::uint16_t open_conflict(int slot, std::uint8_t revision);
  [[nodiscard]] bool note_lane_part(int slot, int part, const Frame& frame);
  [[nodiscard]] bool note_conflict_part(int slot, int part, std::uint16_t before, const Frame& frame);
  // Records that come into use or go out of it change the digest.
  void announce(const Announced& announced);
  void use_lanes(int half, std::uint32_t lanes);
  void change_digest(std::uint16_t out, std::uint16_t in);
  [[nodiscard]] std::uint16_t conflict_check(int slot) const;
  [[nodiscard]] bool complete() const;
  [[nodiscard]] std::uint16_t revisions(int half) const;
  [[nodiscard]] bool plausible() const;
  [[nodiscard]] bool finish_if_whole();
  void reject();

  Map whole_;
  Map assembling_;
  Progress<kMaxLaneParts> lane_progress_[kMaxLanes];
  std::uint16_t lane_checks_[kMaxLanes] = {};  ///< of all parts of each
  Progress<kConflictParts> conflict_progress_[kMaxConflicts];
  E2eReceiver header_;
  Announced announced_;
  Announced whole_announced_;
  bool header_seen_ = false;
  bool have_whole_ = false;
  bool confirmed_ = false;
  bool revised_ = false;  ///< a record took another revision since whole_ was made
  std::uint8_t generation_ = 0;
  std::uint32_t in_use_[2] = {};
  std::uint16_t revisions_[2] = {};
  std::uint8_t halves_ = 0;   ///< bit i: in_use_[i] and revisions_[i] of this generation arrived
  std::uint16_t digest_ = 0;  ///< of the records in use, as far as they are there
  std::uint16_t rejected_ = 0;
};

}  // namespace s4tp::wire
