#include "firmware/wire/codec.hpp"
#include "firmware/wire/crc16.hpp"
#include "firmware/wire/lane_map.hpp"
#include "firmware/wire/map_record.hpp"

namespace s4tp::wire {
namespace {

constexpr std::uint32_t kHeaderPeriod_ms = 100;
constexpr std::uint32_t kRepeatPeriod_ms = 4800;  ///< 5 s less what a burst of changes may take
constexpr int kHeaderParts = 3;                   ///< MapHeader, lower and upper MapSlots

/// Times wrap, so they are compared by their difference.
bool reached(std::uint32_t now_ms, std::uint32_t due_ms) {
  return now_ms - due_ms < 0x80000000U;
}

bool sendable(const Lane& lane) {
  if (!lane.present || lane.point_count < 2 || lane.point_count > kMaxLanePoints) return false;
  Frame frame;
  for (int part = 0; part < part_count(lane); ++part) {
    // Links are put right afterwards.
    if (part != kLaneLinksPart && !encode_part(lane, 0, 0, part, frame)) return false;
  }
  return true;
}

bool sendable(const Conflict& conflict, const LaneSet& lanes) {
  Frame frame;
  return conflict.present && conflict_holds(conflict, lanes) && encode_part(conflict, 0, 0, 0, frame) &&
         encode_part(conflict, 0, 0, 1, frame);
}

void drop_dead_link(std::uint8_t& link, const LaneSet& lanes) {
  if (!contains(lanes, link)) link = kNoLane;
}

void drop_dead_links(Lane& lane, const LaneSet& lanes) {
  for (std::uint8_t& successor : lane.successors) drop_dead_link(successor, lanes);
  drop_dead_link(lane.left, lanes);
  drop_dead_link(lane.right, lanes);
}

template <typename Record>
bool same_on_wire(const Record& a, const Record& b) {
  if (part_count(a) != part_count(b)) return false;
  for (int part = 0; part < part_count(a); ++part) {
    Frame of_a;
    Frame of_b;
    if (!encode_part(a, 0, 0, part, of_a) || !encode_part(b, 0, 0, part, of_b)) return false;
    for (int i = 0; i < of_a.length; ++i) {
      if (of_a.data[i] != of_b.data[i]) return false;
    }
  }
  return true;
}

}  // namespace

void MapSender::update(const Map& map) {
  const bool lanes_changed = take_lanes(map);
  const bool conflicts_changed = take_conflicts(map);
  if (started_ && !lanes_changed && !conflicts_changed) return;
  started_ = true;
  ++generation_;
  make_digest();
}

bool MapSender::next(std::uint32_t now_ms, Frame& frame) {
  if (!started_) return false;
  if (header_part_ > 0 || !header_sent_ || reached(now_ms, header_ms_ + kHeaderPeriod_ms)) {
    return header_frame(now_ms, frame);
  }
  if (record_ < 0) {
    record_ = choose_record(now_ms);
    record_part_ = 0;
    if (record_ < 0) return false;
    progress_[record_].sent_ms = now_ms;
  }
  const bool encoded = encode_part(record_, record_part_, frame);
  if (++record_part_ == frame_count(record_)) {
    progress_[record_].changed = false;
    record_ = -1;
  }
  return encoded;
}

bool MapSender::in_use(int record) const {
  return record < kMaxLanes ? contains(lanes_in_use_, record) : record - kMaxLanes < conflict_count_;
}

int MapSender::frame_count(int record) const {
  return record < kMaxLanes ? part_count(map_.lanes[record]) : part_count(map_.conflicts[record - kMaxLanes]);
}

bool MapSender::encode_part(int record, int part, Frame& frame) const {
  const std::uint8_t revision = progress_[record].revision;
  if (record < kMaxLanes) return wire::encode_part(map_.lanes[record], record, revision, part, frame);
  const int slot = record - kMaxLanes;
  return wire::encode_part(map_.conflicts[slot], slot, revision, part, frame);
}

/// \return whether anything that the other end can see changed
bool MapSender::take_lanes(const Map& map) {
  LaneSet before = {lanes_in_use_[0], lanes_in_use_[1]};
  lanes_in_use_[0] = 0;
  lanes_in_use_[1] = 0;
  lane_count_ = 0;
  unsigned left_out = map.lanes_left_out;
  for (int slot = 0; slot < kMaxLanes; ++slot) {
    if (sendable(map.lanes[slot])) {
      lanes_in_use_[slot / 32] |= std::uint32_t{1} << (slot % 32);
      ++lane_count_;
    } else if (map.lanes[slot].present) {
      ++left_out;
    }
  }
  const auto lanes_left_out = static_cast<std::uint8_t>(left_out < 0xFFU ? left_out : 0xFFU);
  bool changed = lanes_left_out != map_.lanes_left_out;
  map_.lanes_left_out = lanes_left_out;
  for (int slot = 0; slot < kMaxLanes; ++slot) {
    const bool was_there = contains(before, slot);
    if (!contains(lanes_in_use_, slot)) {
      if (record_ == slot) record_ = -1;
      changed = changed || was_there;
      continue;
    }
    Lane lane = map.lanes[slot];
    drop_dead_links(lane, lanes_in_use_);
    if (was_there && same_on_wire(lane, map_.lanes[slot])) continue;
    map_.lanes[slot] = lane;
    revise(slot);
    changed = true;
  }
  return changed;
}

/// \return whether anything that the other end can see changed
bool MapSender::take_conflicts(const Map& map) {
  const int count_before = conflict_count_;
  bool holds[kMaxConflicts];
  conflict_count_ = 0;
  for (int slot = 0; slot < kMaxConflicts; ++slot) {
    holds[slot] = sendable(map.conflicts[slot], lanes_in_use_);
    if (holds[slot]) conflict_count_ = slot + 1;
  }
  if (record_ >= kMaxLanes + conflict_count_) record_ = -1;
  bool changed = conflict_count_ != count_before;
  for (int slot = 0; slot < conflict_count_; ++slot) {
    const Conflict conflict = holds[slot] ? map.conflicts[slot] : Conflict{};
    if (slot < count_before && same_on_wire(conflict, map_.conflicts[slot])) continue;
    map_.conflicts[slot] = conflict;
    revise(kMaxLanes + slot);
    changed = true;
  }
  return changed;
}

void MapSender::revise(int record) {
  Progress& progress = progress_[record];
  progress.revision = static_cast<std::uint8_t>((progress.revision + 1U) % kRevisions);
  progress.changed = true;
  if (record_ == record) record_ = -1;
  progress.check = 0;
  for (int part = 0; part < frame_count(record); ++part) {
    Frame frame;
    if (!encode_part(record, part, frame)) continue;
    progress.check = static_cast<std::uint16_t>(progress.check + frame_check(frame));
  }
}

void MapSender::make_digest() {
  digest_ = 0;
  for (int record = 0; record < kRecords; ++record) {
    if (in_use(record)) digest_ = static_cast<std::uint16_t>(digest_ + progress_[record].check);
  }
}

std::uint16_t MapSender::revisions(int half) const {
  RevisionDigest digest;
  const int lane = half * RevisionDigest::kLanes;
  for (int slot = lane; slot < lane + RevisionDigest::kLanes; ++slot) {
    if (in_use(slot)) digest.add(progress_[slot].revision);
  }
  const int conflict = kMaxLanes + half * RevisionDigest::kConflicts;
  for (int record = conflict; record < conflict + RevisionDigest::kConflicts; ++record) {
    if (in_use(record)) digest.add(progress_[record].revision);
  }
  return digest.value();
}

bool MapSender::header_frame(std::uint32_t now_ms, Frame& frame) {
  const int part = header_part_;
  header_part_ = (header_part_ + 1) % kHeaderParts;
  if (part > 0) {
    MapSlots slots;
    slots.generation = generation_;
    slots.half = static_cast<std::uint8_t>(part - 1);
    slots.in_use = lanes_in_use_[slots.half];
    slots.revisions = revisions(slots.half);
    if (!encode(slots, frame)) return false;
    e2e_seal(frame);
    return true;
  }
  header_ms_ = now_ms;
  header_sent_ = true;
  MapHeader header;
  header.generation = generation_;
  header.lane_count = static_cast<std::uint8_t>(lane_count_);
  header.conflict_count = static_cast<std::uint8_t>(conflict_count_);
  header.lanes_left_out = map_.lanes_left_out;
  header.digest = digest_;
  if (!encode(header, frame)) return false;
  header_.protect(frame);
  return true;
}

/// A changed record, else the one sent longest ago when a repetition is due. \return -1: none
int MapSender::choose_record(std::uint32_t now_ms) {
  int oldest = -1;
  std::uint32_t count = 0;
  for (int record = 0; record < kRecords; ++record) {
    if (!in_use(record)) continue;
    if (progress_[record].changed) return record;
    ++count;
    if (oldest < 0 || now_ms - progress_[record].sent_ms > now_ms - progress_[oldest].sent_ms)
      oldest = record;
  }
  if (oldest < 0) return -1;
  const std::uint32_t interval_ms = kRepeatPeriod_ms / count;
  if (!reached(now_ms, repeated_ms_ + interval_ms)) return -1;
  repeated_ms_ += interval_ms;
  // After a long pause there are no arrears to make up for.
  if (now_ms - repeated_ms_ > kRepeatPeriod_ms) repeated_ms_ = now_ms;
  return oldest;
}

}  // namespace s4tp::wire
