#pragma once
/// A CAN bus whose frames are authentic: stands between an end's application and its bus.
///
/// \code
///   application  send --> frames as they come, behind each group its companion  --> bus
///   application  <-- receive   a group once its companion verifies, else never  <-- bus
/// \endcode
/// | group | frames | companion | goes out |
/// |---|---|---|---|
/// | command | Command | CommandAuth | at once |
/// | motion | Motion, Steering, Pose | MotionAuth | before the next frame that is none of them (TICK) |
/// | tracks | TrackList and its members | TrackListAuth | with the last member its count names |
/// | map | MapHeader, MapSlots, records in use | MapAuth | behind the slots, and when changed records are there |
///
/// AUTH-001 Of these messages nothing reaches the application but what a companion has verified; AUTH-005 so
/// a group that was forged, replayed, put together from two, or that lacks a frame does not. All others
/// (TICK, versions, map origin, reports) pass as they are, and nothing that moves the car is in them.
/// AUTH-020 Of the map the ECU's records are those that a MapAuth has verified, all of them, under the head
/// that names them; they come out in the tick in which the last changed frame is on the bus.
/// AUTH-008 An end makes companions for what it says itself and for nothing it has heard.
/// AUTH-006 Frames of a group come out in ascending order of their ids, in one go; of the map the head and
/// the records that changed, when nothing else is waiting. A frame of a record that has been verified before
/// passes at once.
///
/// AUTH-040 Undisturbed, an application plans what it would plan without authentication, to the bit.
/// AUTH-041 Commands, motion, lists and map records that somebody else says, invented or recorded, change
/// neither plan nor car, but by what they keep from its receiver (below). AUTH-042 What is kept out is missing,
/// and supervision says so: kMotionMissing, kPoseMissing, kSteeringMissing, kTracksStale, kMapStale and what
/// follows; the car brakes without commands.
///
/// Whoever floods the bus, or slips a frame into a group, keeps that group from its receiver: then it is
/// missing, and the supervision of the application says so. Static memory: 29 KiB, most of it the map
/// as it stands on the bus and as it was verified last.

#include <cstdint>

#include "firmware/secoc/frame_group.hpp"
#include "firmware/secoc/map_records.hpp"
#include "firmware/secoc/session.hpp"
#include "hal/authenticator.hpp"
#include "hal/can.hpp"

namespace s4tp::secoc {

/// What became of companions that came in.
struct Tally {
  std::uint32_t verified = 0;
  std::uint32_t refused = 0;  ///< forged, replayed, without their group, or under another key
};

class AuthenticCan final : public hal::Can {
 public:
  static constexpr int kLookedAt = 256;  ///< frames a receive() looks at before it answers

  /// \param below, keys  must outlive this
  AuthenticCan(hal::Can& below, hal::Authenticator& keys, End end);

  [[nodiscard]] bool receive(hal::CanFrame& frame) override;
  [[nodiscard]] bool send(const hal::CanFrame& frame) override;
  [[nodiscard]] hal::CanState state() const override { return below_.state(); }
  /// Those of the bus; companions refused count as errors.
  [[nodiscard]] hal::CanCounters counters() const override;

  /// Asks the other end for a session, as long as there is none. Once this end's periodic frames go out
  /// (Command, Motion) it does so by itself.
  void announce();
  [[nodiscard]] const Session& session() const { return session_; }
  [[nodiscard]] const Tally& tally() const { return tally_; }

 private:
  /// A group that comes in or goes out.
  struct Open {
    bool begun = false;
    FrameGroup frames;
  };

  // Out.
  void seal(const wire::Frame& frame);
  void seal_tracks(const wire::Frame& frame);
  void seal_map(const wire::Frame& frame);
  void send_group(Group group, Open& open);
  void send_map_companion();
  void send_companion(Message& message);
  void pass_period();
  void say(const Nonce& nonce);

  // In.
  void take(const hal::CanFrame& can_frame);
  void hold(Group group, const wire::Frame& frame);
  void take_record(const wire::Frame& frame);
  void judge(Group group, const Companion& companion);
  [[nodiscard]] bool judge_map(const Companion& companion);
  [[nodiscard]] bool release(hal::CanFrame& frame);
  [[nodiscard]] bool is_incoming(Group group) const;
  /// \pre group is not kMap
  [[nodiscard]] Open& open_of(Group group);

  hal::Can& below_;
  hal::Authenticator& keys_;
  End end_;
  Session session_;
  Tally tally_;

  Open motion_;
  Open tracks_;
  Open command_;
  int list_frames_ = 0;  ///< of the list that goes out

  MapHead head_;
  MapRecords records_;   ///< as they stand on the bus
  MapRecords verified_;  ///< in: of the last map that was
  MapHead verified_head_;

  FrameGroup ready_;  ///< verified, to be taken
  int ready_at_ = 0;
  hal::CanFrame passed_;  ///< neither held nor swallowed
  bool has_passed_ = false;
  int head_at_ = MapHead::kFrames;  ///< next one of the verified head to be released; -1: the header before
  bool shown_ = false;              ///< a map has been released
  bool changed_[kRecords] = {};     ///< to be released
  int record_at_ = 0;
  int part_at_ = 0;
};

static_assert(sizeof(AuthenticCan) <= 30 * 1024, "docs/threat_model.md says 29 KiB");

}  // namespace s4tp::secoc
