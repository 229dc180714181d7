#pragma once
/// What a receiver of the map has to decide, without any thought of what it costs.

#include <algorithm>
#include <array>
#include <bit>
#include <map>
#include <optional>

#include "firmware/wire/codec.hpp"
#include "firmware/wire/crc16.hpp"
#include "firmware/wire/map_record.hpp"

namespace s4tp::wire {

/// It keeps frames and nothing made of them: on every one it sums up all and looks at all.
class PlainReceiver {
 public:
  bool accept(const Frame& frame) {
    switch (frame.id) {
      case kMapHeaderId:
        return accept_header(frame);
      case kMapSlotsId:
        return accept_slots(frame);
      case kLaneHeaderId:
        return accept_part<LaneHeader>(frame, [](const auto& part) { return Place{part.lane, 0}; });
      case kLaneRouteId:
        return accept_part<LaneRoute>(frame, [](const auto& part) { return Place{part.lane, 1}; });
      case kLaneLinksId:
        return accept_part<LaneLinks>(frame, [](const auto& part) { return Place{part.lane, 2}; });
      case kLanePointId:
        return accept_part<LanePoint>(frame, [](const auto& part) {
          return Place{part.lane, 3 + part.index};
        });
      case kConflictFirstId:
        return accept_part<ConflictFirst>(frame,
                                          [](const auto& part) { return of_conflict(part.conflict, 0); });
      default:
        return accept_part<ConflictSecond>(frame,
                                           [](const auto& part) { return of_conflict(part.conflict, 1); });
    }
  }

  void nothing_arrived() {
    static_cast<void>(protection_.nothing_arrived());
    confirmed_ = false;
  }

  bool confirmed() const { return confirmed_; }
  int rejected() const { return rejected_; }

  /// Of the records that these would be, as far as they are there.
  std::uint16_t digest(const LaneSet& lanes, int conflicts) const {
    unsigned sum = 0;
    for (const auto& [slot, record] : records_) {
      if (!in_use(slot, lanes, conflicts)) continue;
      for (const auto& [part, frame] : record.parts) {
        if (part < part_count_of(slot)) sum += frame_check(frame);
      }
    }
    return static_cast<std::uint16_t>(sum);
  }

  /// Of the revisions that these records have in a half of the slots.
  std::uint16_t revisions(int half, const LaneSet& lanes, int conflicts) const {
    RevisionDigest digest;
    for (const auto& [slot, record] : records_) {
      const int half_of_slot =
          slot < kMaxLanes ? slot / RevisionDigest::kLanes : (slot - kMaxLanes) / RevisionDigest::kConflicts;
      if (half_of_slot == half && in_use(slot, lanes, conflicts))
        digest.add(static_cast<std::uint8_t>(record.revision));
    }
    return digest.value();
  }

  /// Whether all of a record is there.
  bool has(int record) const {
    if (!records_.contains(record)) return false;
    const int count = part_count_of(record);
    for (int part = 0; part < count; ++part) {
      if (!records_.at(record).parts.contains(part)) return false;
    }
    return record >= kMaxLanes || count >= kFirstPointPart + 2;
  }

  /// Whether the map is what the frames say that are in use.
  bool is_in(const Map& map) const {
    for (int slot = 0; slot < kMaxLanes; ++slot) {
      if (map.lanes[slot].present != contains(in_use_, slot)) return false;
      if (contains(in_use_, slot) && !is_in(map.lanes[slot], slot, slot)) return false;
    }
    for (int slot = 0; slot < kMaxConflicts; ++slot) {
      const int record = kMaxLanes + slot;
      if (map.conflicts[slot].present != (in_use(record) && !is_hole(record))) return false;
      if (map.conflicts[slot].present && !is_in(map.conflicts[slot], slot, record)) return false;
    }
    return map.lanes_left_out == head_->lanes_left_out;
  }

 private:
  struct Place {
    int record;  ///< lanes first
    int part;
  };
  struct Record {
    int revision = -1;
    std::map<int, Frame> parts;
  };

  static Place of_conflict(int slot, int part) { return {kMaxLanes + slot, part}; }

  bool accept_header(const Frame& frame) {
    const E2eState state = protection_.check(frame);
    if (state == E2eState::kInitial || state == E2eState::kRepeated) return false;
    MapHeader head;
    if (!E2eReceiver::trusted(state) || !decode(frame, head)) return reject();
    if (!head_ || head_->generation != head.generation) slots_ = {};
    head_ = head;
    confirmed_ = whole_ && whole_->lane_count == head.lane_count &&
                 whole_->conflict_count == head.conflict_count &&
                 whole_->lanes_left_out == head.lanes_left_out && whole_->digest == head.digest;
    return look();
  }

  bool accept_slots(const Frame& frame) {
    MapSlots slots;
    if (!e2e_crc_fits(frame) || !decode(frame, slots)) return reject();
    if (!head_ || slots.generation != head_->generation) return false;
    in_use_[slots.half] = slots.in_use;
    slots_[slots.half] = slots;
    return look();
  }

  template <typename Message, typename Where>
  bool accept_part(const Frame& frame, Where where) {
    Message message;
    if (!e2e_crc_fits(frame) || !decode(frame, message)) return reject();
    const Place place = where(message);
    Record& record = records_[place.record];
    if (record.revision != message.revision) {
      record = {message.revision, {}};
      revised_ = true;
    }
    record.parts[place.part] = frame;
    return look();
  }

  bool reject() {
    ++rejected_;
    return false;
  }

  bool look() {
    if (!head_ || (confirmed_ && !revised_)) return false;
    if (digest(in_use_, head_->conflict_count) != head_->digest || !complete()) return false;
    if (!plausible()) {
      slots_ = {};
      return reject();
    }
    whole_ = head_;
    revised_ = false;
    confirmed_ = true;
    return true;
  }

  static bool in_use(int record, const LaneSet& lanes, int conflicts) {
    return record < kMaxLanes ? contains(lanes, record) : record - kMaxLanes < conflicts;
  }
  bool in_use(int record) const { return in_use(record, in_use_, head_->conflict_count); }

  int part_count_of(int record) const {
    if (record >= kMaxLanes) return kConflictParts;
    LaneHeader header;
    const auto& parts = records_.at(record).parts;
    const bool known = parts.contains(0) && decode(parts.at(0), header);
    return kFirstPointPart + (known ? header.point_count : 0);
  }

  bool complete() const {
    if (!slots_[0] || !slots_[1]) return false;
    if (std::popcount(in_use_[0]) + std::popcount(in_use_[1]) != head_->lane_count) return false;
    for (int record = 0; record < kMaxLanes + kMaxConflicts; ++record) {
      if (in_use(record) && !has(record)) return false;
    }
    return std::ranges::all_of(slots_, [&](const auto& slots) {
      return slots->revisions == revisions(slots->half, in_use_, head_->conflict_count);
    });
  }

  /// Whether a conflict that is there is none.
  bool is_hole(int record) const {
    ConflictFirst first;
    return decode(records_.at(record).parts.at(0), first) && first.first == first.second;
  }

  bool plausible() const {
    for (const auto& [record, frames] : records_) {
      if (!in_use(record)) continue;
      const auto& parts = frames.parts;
      if (record < kMaxLanes ? !links_lead_to_lanes(parts) : !is_hole(record) && !is_of_lanes(parts))
        return false;
    }
    return true;
  }

  bool links_lead_to_lanes(const std::map<int, Frame>& parts) const {
    LaneLinks links;
    if (!decode(parts.at(2), links)) return false;
    const int lanes[] = {links.successor_0, links.successor_1, links.successor_2, links.left, links.right};
    return std::ranges::all_of(lanes, [&](int lane) { return lane == kNoLane || contains(in_use_, lane); });
  }

  bool is_of_lanes(const std::map<int, Frame>& parts) const {
    ConflictFirst first;
    ConflictSecond second;
    return decode(parts.at(0), first) && decode(parts.at(1), second) && contains(in_use_, first.first) &&
           contains(in_use_, first.second) && first.first_entry_m <= first.first_exit_m &&
           second.second_entry_m <= second.second_exit_m;
  }

  template <typename OfMap>
  bool is_in(const OfMap& of_map, int slot, int record) const {
    const auto& [revision, parts] = records_.at(record);
    for (int part = 0; part < part_count(of_map); ++part) {
      Frame frame;
      if (!encode_part(of_map, slot, static_cast<std::uint8_t>(revision), part, frame)) return false;
      if (!std::ranges::equal(frame.data, parts.at(part).data)) return false;
    }
    return part_count(of_map) == part_count_of(record);
  }

  std::map<int, Record> records_;
  std::optional<MapHeader> head_;
  std::optional<MapHeader> whole_;
  E2eReceiver protection_;
  LaneSet in_use_ = {};
  std::array<std::optional<MapSlots>, 2> slots_;
  bool confirmed_ = false;
  bool revised_ = false;
  int rejected_ = 0;
};

}  // namespace s4tp::wire
