#pragma once
/// The track list on the wire: a header (TrackList) and two members a track (TrackPose, TrackMotion), all of
/// one generation. WIRE-020 A list counts only when whole; until then the previous one stands and ages.
/// Those come into it that can be near our box's centre soonest: by distance less kListLeadS of the difference of the
/// two velocities nobody left out comes before any of these.
/// WIRE-023 Whole means that the header's digest fits all members, too: against corruption, not forgery.

#include <cstdint>

#include "firmware/wire/e2e.hpp"
#include "firmware/wire/frame.hpp"

namespace s4tp::wire {

inline constexpr int kMaxTracks = 16;
inline constexpr float kListLeadS = 2.0F;  ///< of relative velocity counts as way when a list is cut

struct Track {
  std::uint8_t id = 0;
  float x_m = 0.0F;  ///< box centre
  float y_m = 0.0F;
  float heading_rad = 0.0F;
  float speed_mps = 0.0F;
  float acceleration_mps2 = 0.0F;
  float yaw_rate_radps = 0.0F;
  float length_m = 0.0F;
  float width_m = 0.0F;
};

struct Tracks {
  std::uint16_t vehicle_time_ms = 0;
  std::uint8_t count = 0;
  std::uint8_t left_out = 0;  ///< how many more are seen; 31: or more
  Track items[kMaxTracks];
};

/// The members of a list as they stand on the bus.
struct TrackMembers {
  std::uint8_t poses[kMaxTracks][8] = {};
  std::uint8_t motions[kMaxTracks][8] = {};
};
/// CRC-16 over all bytes of the first `count` pairs, in their order.
[[nodiscard]] std::uint16_t list_digest(const TrackMembers& members, int count);

/// Sends lists: call start() with a new one, then next() until it answers false.
class TrackListSender {
 public:
  /// WIRE-021 A track with a value the wire cannot carry is left out and counted as such.
  void start(const Tracks& tracks);
  [[nodiscard]] bool next(Frame& frame);

 private:
  [[nodiscard]] bool seal_member(int part, Frame& frame) const;

  Tracks tracks_;
  E2eSender header_;
  std::uint8_t generation_ = 0;
  int sent_ = 0;
  int total_ = 0;
};

/// Puts lists together. Members count from their header on and until the next one. WIRE-024 A member that
/// comes again bit for bit changes nothing (CAN retransmits); one that comes again and says something else
/// voids the list. The generation tells 16 lists apart, so a frame would have to be 1.6 s late to be
/// mistaken.
class TrackListReceiver {
 public:
  /// Takes a frame of one of the three messages. \return whether a list has just become whole
  [[nodiscard]] bool accept(const Frame& frame);
  /// WIRE-022 To be called when a period (100 ms) ended without a header: the list begun is given up.
  void nothing_arrived();
  /// The newest whole list; meaningful once accept() has answered true.
  [[nodiscard]] const Tracks& tracks() const { return whole_; }
  [[nodiscard]] std::uint16_t broken_lists() const { return broken_; }  ///< replaced before they were whole
  [[nodiscard]] std::uint16_t voided_lists() const { return voided_; }  ///< by digest or contradiction
  [[nodiscard]] std::uint16_t rejected_frames() const { return rejected_; }

 private:
  [[nodiscard]] bool accept_header(const Frame& frame);
  [[nodiscard]] bool accept_pose(const Frame& frame);
  [[nodiscard]] bool accept_motion(const Frame& frame);
  [[nodiscard]] bool awaits(std::uint8_t generation, std::uint8_t index);
  /// Whether the member is new; one that contradicts an earlier one voids the list.
  [[nodiscard]] bool is_new(const Frame& frame, std::uint16_t& arrived, unsigned index,
                            std::uint8_t (&kept)[8]);
  void make_void();
  [[nodiscard]] bool finish_if_whole();
  void give_up();
  void reject();

  Tracks whole_;
  Tracks assembling_;
  TrackMembers members_;
  std::uint16_t digest_ = 0;
  E2eReceiver header_;
  bool begun_ = false;
  std::uint8_t generation_ = 0;
  std::uint16_t poses_ = 0;  ///< bit i: TrackPose i arrived
  std::uint16_t motions_ = 0;
  std::uint16_t broken_ = 0;
  std::uint16_t voided_ = 0;
  std::uint16_t rejected_ = 0;
};

}  // namespace s4tp::wire
