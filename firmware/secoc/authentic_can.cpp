#include "firmware/secoc/authentic_can.hpp"

#include "firmware/can/frames.hpp"
#include "firmware/secoc/frames.hpp"
#include "firmware/wire/codec.hpp"
#include "firmware/wire/e2e.hpp"

namespace s4tp::secoc {

AuthenticCan::AuthenticCan(hal::Can& below, hal::Authenticator& keys, End end)
    : below_(below), keys_(keys), end_(end), session_(keys, end) {}

bool AuthenticCan::is_incoming(Group group) const {
  return (group == Group::kCommand) == (end_ == End::kWorld);
}

AuthenticCan::Open& AuthenticCan::open_of(Group group) {
  if (group == Group::kCommand) return command_;
  return group == Group::kMotion ? motion_ : tracks_;
}

hal::CanCounters AuthenticCan::counters() const {
  hal::CanCounters counters = below_.counters();
  counters.errors += tally_.refused;
  return counters;
}

// Out.

void AuthenticCan::announce() {
  Nonce nonce;
  if (session_.ask(nonce)) say(nonce);
}

void AuthenticCan::say(const Nonce& nonce) {
  static_cast<void>(below_.send(to_hal(write_nonce(end_, nonce))));  // said again if it is lost
}

void AuthenticCan::pass_period() {
  Nonce nonce;
  if (session_.tick(nonce)) say(nonce);
}

bool AuthenticCan::send(const hal::CanFrame& can_frame) {
  if (!is_incoming(Group::kMotion) && motion_.begun && !is_motion(can_frame.id))
    send_group(Group::kMotion, motion_);
  const bool sent = below_.send(can_frame);
  Group group{};
  if (can_frame.length != 8 || !find_group(can_frame.id, group) || is_incoming(group)) return sent;
  seal(to_wire(can_frame));
  return sent;
}

void AuthenticCan::seal(const wire::Frame& frame) {
  if (is_map(frame.id)) return seal_map(frame);
  if (frame.id == wire::kTrackListId || is_member(frame.id)) return seal_tracks(frame);
  const bool command = frame.id == wire::kCommandId;
  Open& open = open_of(command ? Group::kCommand : Group::kMotion);
  if (begins(frame.id)) {
    open.frames.clear();
    open.begun = true;
  }
  if (!open.begun || !open.frames.add(frame)) return;
  if (command) send_group(Group::kCommand, command_);
  if (begins(frame.id)) pass_period();
}

void AuthenticCan::seal_tracks(const wire::Frame& frame) {
  wire::TrackList list;
  if (wire::decode(frame, list)) {
    tracks_.frames.clear();
    tracks_.begun = true;
    list_frames_ = 1 + 2 * list.count;
  }
  if (!tracks_.begun || !tracks_.frames.add(frame)) return;
  if (tracks_.frames.size() == list_frames_) send_group(Group::kTracks, tracks_);
}

void AuthenticCan::seal_map(const wire::Frame& frame) {
  RecordPlace place;
  if (head_.take(frame)) {
    wire::MapSlots slots;
    if (wire::decode(frame, slots) && slots.half == 1) send_map_companion();
  } else if (find_place(frame, place) && records_.take(frame, place)) {
    send_map_companion();
  }
}

void AuthenticCan::send_map_companion() {
  if (!session_.has_key() || !records_.whole(head_)) return;
  Message message(Group::kMap);
  if (records_.add_to(message, head_, keys_)) send_companion(message);
}

void AuthenticCan::send_group(Group group, Open& open) {
  open.begun = false;
  Message message(group);
  open.frames.add_to(message);
  send_companion(message);
}

void AuthenticCan::send_companion(Message& message) {
  Companion companion;
  if (is_incoming(message.group()) || !session_.seal(message, companion)) return;
  static_cast<void>(below_.send(to_hal(write_companion(message.group(), companion))));
}

// In.

bool AuthenticCan::receive(hal::CanFrame& frame) {
  for (int i = 0; i <= kLookedAt; ++i) {
    if (ready_at_ < ready_.size()) {
      frame = to_hal(ready_.at(ready_at_++));
      return true;
    }
    if (has_passed_) {
      frame = passed_;
      has_passed_ = false;
      return true;
    }
    hal::CanFrame below;
    if (!below_.receive(below)) return release(frame);
    take(below);
  }
  return false;
}

void AuthenticCan::take(const hal::CanFrame& can_frame) {
  Group group{};
  const bool protects = find_group(can_frame.id, group);
  if (can_frame.length == 8) {
    const wire::Frame frame = to_wire(can_frame);
    Companion companion;
    Nonce nonce;
    if (read_nonce(frame, end_ == End::kEcu ? End::kWorld : End::kEcu, nonce)) {
      session_.hear(nonce);
      return;
    }
    Group closed{};
    if (read_companion(frame, closed, companion)) return judge(closed, companion);
    if (protects) return hold(group, frame);
  }
  if (protects) return;
  passed_ = can_frame;
  has_passed_ = true;
}

void AuthenticCan::hold(Group group, const wire::Frame& frame) {
  if (!is_incoming(group) || !wire::e2e_crc_fits(frame)) return;
  if (group == Group::kMap) {
    if (!head_.take(frame)) take_record(frame);
    return;
  }
  Open& open = open_of(group);
  if (begins(frame.id) && !open.frames.has(frame)) {
    open.frames.clear();
    open.begun = true;
  }
  // What is too much belongs to no group that will verify.
  if (open.begun) static_cast<void>(open.frames.add(frame));
}

void AuthenticCan::take_record(const wire::Frame& frame) {
  RecordPlace place;
  if (!find_place(frame, place)) return;
  static_cast<void>(records_.take(frame, place));
  if (!verified_.has(frame, place)) return;
  passed_ = to_hal(frame);
  has_passed_ = true;
}

void AuthenticCan::judge(Group group, const Companion& companion) {
  if (!is_incoming(group)) return;
  bool genuine = false;
  if (group == Group::kMap) {
    genuine = judge_map(companion);
  } else {
    Open& open = open_of(group);
    Message message(group);
    open.frames.add_to(message);
    genuine = open.begun && session_.verify(message, companion);
    if (genuine) {
      ready_ = open.frames;
      ready_at_ = 0;
      open.begun = false;
      open.frames.clear();
    }
  }
  ++(genuine ? tally_.verified : tally_.refused);
}

/// The map as it stands on the bus; where that has been disturbed, the one before under the new head.
bool AuthenticCan::judge_map(const Companion& companion) {
  MapRecords* const candidates[] = {&records_, &verified_};
  for (MapRecords* const records : candidates) {
    if (!records->whole(head_)) continue;
    Message message(Group::kMap);
    if (!records->add_to(message, head_, keys_) || !session_.verify(message, companion)) continue;
    for (int record = 0; record < kRecords; ++record) {
      if (!head_.in_use(record) || verified_.same(record, *records)) continue;
      verified_.copy(record, *records);
      changed_[record] = true;
      if (record == record_at_) part_at_ = 0;
    }
    verified_head_ = head_;
    head_at_ = !shown_ && head_.said_before() ? -1 : 0;
    shown_ = true;
    return true;
  }
  return false;
}

bool AuthenticCan::release(hal::CanFrame& frame) {
  if (head_at_ < 0) {
    ++head_at_;
    frame = to_hal(verified_head_.before());
    return true;
  }
  if (head_at_ < MapHead::kFrames) {
    frame = to_hal(verified_head_.frame(head_at_++));
    return true;
  }
  for (int i = 0; i < kRecords && !changed_[record_at_]; ++i) {
    record_at_ = (record_at_ + 1) % kRecords;
    part_at_ = 0;
  }
  if (!changed_[record_at_]) return false;
  frame = to_hal(verified_.frame(record_at_, part_at_++));
  changed_[record_at_] = part_at_ < verified_.parts(record_at_);
  return true;
}

}  // namespace s4tp::secoc
