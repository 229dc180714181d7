#include "firmware/wire/codec.hpp"
#include "firmware/wire/crc16.hpp"
#include "firmware/wire/lane_map.hpp"
#include "firmware/wire/map_record.hpp"

namespace s4tp::wire {
namespace {

constexpr std::uint8_t kBothHalves = 3;

int count_bits(std::uint32_t word) {
  int count = 0;
  for (int bit = 0; bit < 32; ++bit) count += static_cast<int>((word >> bit) & 1U);
  return count;
}

void fill(const LaneHeader& header, Lane& lane) {
  lane.kind = header.kind;
  lane.in_junction = header.in_junction != 0;
  lane.on_route = header.on_route != 0;
  lane.point_count = header.point_count;
  lane.changes_needed = header.changes_needed;
  lane.speed_limit_mps = header.speed_limit_mps;
  lane.width_m = header.width_m;
  lane.stop_line_m = header.has_stop_line != 0 ? header.stop_line_m : -1.0F;
  lane.signal_state = header.signal_state;
}

void fill(const LaneRoute& route, Lane& lane) {
  lane.route_remaining_m = route.route_remaining_m;
  lane.goal_distance_m = route.goal_distance_m;
}

void fill(const LaneLinks& links, Lane& lane) {
  lane.successors[0] = links.successor_0;
  lane.successors[1] = links.successor_1;
  lane.successors[2] = links.successor_2;
  lane.left = links.left;
  lane.right = links.right;
}

void fill(const LanePoint& point, Lane& lane) {
  lane.x_m[point.index] = point.x_m;
  lane.y_m[point.index] = point.y_m;
}

int part_of(const LaneHeader&) {
  return kLaneHeaderPart;
}
int part_of(const LaneRoute&) {
  return kLaneRoutePart;
}
int part_of(const LaneLinks&) {
  return kLaneLinksPart;
}
int part_of(const LanePoint& point) {
  return kFirstPointPart + point.index;
}

void fill(const ConflictFirst& first, Conflict& conflict) {
  conflict.present = first.first != first.second;
  conflict.first = first.first;
  conflict.second = first.second;
  conflict.priority = first.priority;
  conflict.first_entry_m = first.first_entry_m;
  conflict.first_exit_m = first.first_exit_m;
}

void fill(const ConflictSecond& second, Conflict& conflict) {
  conflict.second_entry_m = second.second_entry_m;
  conflict.second_exit_m = second.second_exit_m;
}

int part_of(const ConflictFirst&) {
  return 0;
}
int part_of(const ConflictSecond&) {
  return 1;
}

}  // namespace

template <int Parts>
bool MapReceiver::Progress<Parts>::has(int count) const {
  const unsigned wanted = (1U << count) - 1U;
  return (parts & wanted) == wanted;
}

template <int Parts>
template <typename Record>
bool MapReceiver::Progress<Parts>::open(std::uint8_t new_revision, Record& record) {
  if (revision == new_revision) return false;
  *this = Progress{};
  revision = new_revision;
  record = Record{};
  return true;
}

template <int Parts>
void MapReceiver::Progress<Parts>::note(int part, const Frame& frame) {
  parts = static_cast<std::uint16_t>(parts | (1U << part));
  checks[part] = frame_check(frame);
}

template <int Parts>
std::uint16_t MapReceiver::Progress<Parts>::check(int count) const {
  unsigned sum = 0;
  for (int part = 0; part < count; ++part) sum += checks[part];
  return static_cast<std::uint16_t>(sum);
}

bool MapReceiver::Announced::same(const Announced& other) const {
  return lane_count == other.lane_count && conflict_count == other.conflict_count &&
         lanes_left_out == other.lanes_left_out && digest == other.digest;
}

bool MapReceiver::accept(const Frame& frame) {
  switch (frame.id) {
    case kMapHeaderId:
      return accept_header(frame);
    case kMapSlotsId:
      return accept_slots(frame);
    case kLaneHeaderId:
      return accept_lane_part<LaneHeader>(frame);
    case kLaneRouteId:
      return accept_lane_part<LaneRoute>(frame);
    case kLaneLinksId:
      return accept_lane_part<LaneLinks>(frame);
    case kLanePointId:
      return accept_lane_part<LanePoint>(frame);
    case kConflictFirstId:
      return accept_conflict_part<ConflictFirst>(frame);
    case kConflictSecondId:
      return accept_conflict_part<ConflictSecond>(frame);
    default:
      return false;
  }
}

void MapReceiver::nothing_arrived() {
  static_cast<void>(header_.nothing_arrived());
  confirmed_ = false;
}

bool MapReceiver::accept_header(const Frame& frame) {
  const E2eState state = header_.check(frame);
  if (state == E2eState::kInitial || state == E2eState::kRepeated) return false;
  MapHeader header;
  if (!E2eReceiver::trusted(state) || !decode(frame, header)) {
    reject();
    return false;
  }
  Announced announced;
  announced.lane_count = header.lane_count;
  announced.conflict_count = header.conflict_count;
  announced.lanes_left_out = header.lanes_left_out;
  announced.digest = header.digest;
  if (!header_seen_ || generation_ != header.generation) halves_ = 0;
  header_seen_ = true;
  generation_ = header.generation;
  announce(announced);
  confirmed_ = have_whole_ && announced_.same(whole_announced_);
  return finish_if_whole();
}

bool MapReceiver::accept_slots(const Frame& frame) {
  MapSlots slots;
  if (!e2e_crc_fits(frame) || !decode(frame, slots)) {
    reject();
    return false;
  }
  if (!header_seen_ || slots.generation != generation_) return false;
  use_lanes(slots.half, slots.in_use);
  revisions_[slots.half] = slots.revisions;
  halves_ = static_cast<std::uint8_t>(halves_ | (1U << slots.half));
  return finish_if_whole();
}

template <typename Message>
bool MapReceiver::accept_lane_part(const Frame& frame) {
  Message message;
  if (!e2e_crc_fits(frame) || !decode(frame, message)) {
    reject();
    return false;
  }
  open_lane(message.lane, message.revision);
  fill(message, assembling_.lanes[message.lane]);
  return note_lane_part(message.lane, part_of(message), frame);
}

template <typename Message>
bool MapReceiver::accept_conflict_part(const Frame& frame) {
  Message message;
  if (!e2e_crc_fits(frame) || !decode(frame, message)) {
    reject();
    return false;
  }
  const std::uint16_t before = open_conflict(message.conflict, message.revision);
  fill(message, assembling_.conflicts[message.conflict]);
  return note_conflict_part(message.conflict, part_of(message), before, frame);
}

void MapReceiver::open_lane(int slot, std::uint8_t revision) {
  if (lane_progress_[slot].open(revision, assembling_.lanes[slot])) revised_ = true;
}

/// \return what the record added to the digest before
std::uint16_t MapReceiver::open_conflict(int slot, std::uint8_t revision) {
  const std::uint16_t before = conflict_check(slot);
  if (conflict_progress_[slot].open(revision, assembling_.conflicts[slot])) revised_ = true;
  return before;
}

bool MapReceiver::note_lane_part(int slot, int part, const Frame& frame) {
  const std::uint16_t before = lane_checks_[slot];
  lane_progress_[slot].note(part, frame);
  lane_checks_[slot] = lane_progress_[slot].check(part_count(assembling_.lanes[slot]));
  if (contains(in_use_, slot)) change_digest(before, lane_checks_[slot]);
  return finish_if_whole();
}

bool MapReceiver::note_conflict_part(int slot, int part, std::uint16_t before, const Frame& frame) {
  conflict_progress_[slot].note(part, frame);
  if (slot < announced_.conflict_count) change_digest(before, conflict_check(slot));
  return finish_if_whole();
}

void MapReceiver::announce(const Announced& announced) {
  const int before = announced_.conflict_count;
  const int now = announced.conflict_count;
  announced_ = announced;
  for (int slot = before; slot < now; ++slot) change_digest(0, conflict_check(slot));
  for (int slot = now; slot < before; ++slot) change_digest(conflict_check(slot), 0);
}

void MapReceiver::use_lanes(int half, std::uint32_t lanes) {
  const std::uint32_t before = in_use_[half];
  in_use_[half] = lanes;
  int slot = 32 * half;
  for (std::uint32_t changed = before ^ lanes; changed != 0; changed >>= 1U, ++slot) {
    if ((changed & 1U) == 0U) continue;
    if (contains(in_use_, slot)) {
      change_digest(0, lane_checks_[slot]);
    } else {
      change_digest(lane_checks_[slot], 0);
    }
  }
}

std::uint16_t MapReceiver::conflict_check(int slot) const {
  return conflict_progress_[slot].check(kConflictParts);
}

void MapReceiver::change_digest(std::uint16_t out, std::uint16_t in) {
  digest_ = static_cast<std::uint16_t>(digest_ - out + in);
}

/// Whether every record in use is there, in the revision that was announced.
bool MapReceiver::complete() const {
  if (halves_ != kBothHalves) return false;
  if (count_bits(in_use_[0]) + count_bits(in_use_[1]) != announced_.lane_count) return false;
  for (int slot = 0; slot < kMaxLanes; ++slot) {
    const Lane& lane = assembling_.lanes[slot];
    if (contains(in_use_, slot) && !(lane.point_count >= 2 && lane_progress_[slot].has(part_count(lane)))) {
      return false;
    }
  }
  for (int slot = 0; slot < announced_.conflict_count; ++slot) {
    if (!conflict_progress_[slot].has(kConflictParts)) return false;
  }
  for (int half = 0; half < 2; ++half) {
    if (revisions(half) != revisions_[half]) return false;
  }
  return true;
}

std::uint16_t MapReceiver::revisions(int half) const {
  RevisionDigest digest;
  const int lane = half * RevisionDigest::kLanes;
  for (int slot = lane; slot < lane + RevisionDigest::kLanes; ++slot) {
    if (contains(in_use_, slot)) digest.add(lane_progress_[slot].revision);
  }
  const int conflict = half * RevisionDigest::kConflicts;
  for (int slot = conflict; slot < conflict + RevisionDigest::kConflicts; ++slot) {
    if (slot < announced_.conflict_count) digest.add(conflict_progress_[slot].revision);
  }
  return digest.value();
}

/// Whether the records fit each other: a sender's fault otherwise.
bool MapReceiver::plausible() const {
  for (int slot = 0; slot < kMaxLanes; ++slot) {
    if (contains(in_use_, slot) && !links_exist(assembling_.lanes[slot], in_use_)) return false;
  }
  for (int slot = 0; slot < announced_.conflict_count; ++slot) {
    const Conflict& conflict = assembling_.conflicts[slot];
    if (conflict.present && !conflict_holds(conflict, in_use_)) return false;
  }
  return true;
}

bool MapReceiver::finish_if_whole() {
  const bool nothing_to_gain = confirmed_ && !revised_;
  if (!header_seen_ || nothing_to_gain || digest_ != announced_.digest || !complete()) return false;
  if (!plausible()) {
    reject();
    halves_ = 0;  // not looked at again before the slots come again
    return false;
  }
  for (int slot = 0; slot < kMaxLanes; ++slot) {
    Lane& lane = whole_.lanes[slot];
    lane = Lane{};
    if (!contains(in_use_, slot)) continue;
    lane = assembling_.lanes[slot];
    lane.present = true;
    // Points beyond the count may be left over from a time when there were more.
    for (int i = lane.point_count; i < kMaxLanePoints; ++i) {
      lane.x_m[i] = 0.0F;
      lane.y_m[i] = 0.0F;
    }
  }
  for (int slot = 0; slot < kMaxConflicts; ++slot) {
    const Conflict& conflict = assembling_.conflicts[slot];
    whole_.conflicts[slot] = slot < announced_.conflict_count && conflict.present ? conflict : Conflict{};
  }
  whole_.lanes_left_out = announced_.lanes_left_out;
  whole_announced_ = announced_;
  have_whole_ = true;
  revised_ = false;
  confirmed_ = true;
  return true;
}

void MapReceiver::reject() {
  if (rejected_ < UINT16_MAX) ++rejected_;
}

}  // namespace s4tp::wire
