#include "firmware/secoc/map_records.hpp"

#include "firmware/wire/codec.hpp"
#include "firmware/wire/crc16.hpp"
#include "firmware/wire/e2e.hpp"

namespace s4tp::secoc {
namespace {

constexpr std::uint8_t kTagLabel = 0;  // no group's number

template <typename Message>
bool find_lane_part(const wire::Frame& frame, int part, RecordPlace& place, Message& message) {
  if (!wire::decode(frame, message)) return false;
  place = {message.lane, part, 0, message.revision};
  return true;
}

template <typename Message>
bool find_conflict_part(const wire::Frame& frame, int part, RecordPlace& place) {
  Message message;
  if (!wire::decode(frame, message)) return false;
  place = {wire::kMaxLanes + message.conflict, part, wire::kConflictParts, message.revision};
  return true;
}

std::uint32_t id_of(int record, int part) {
  if (record >= wire::kMaxLanes) return part == 0 ? wire::kConflictFirstId : wire::kConflictSecondId;
  constexpr std::uint32_t kIds[] = {wire::kLaneHeaderId, wire::kLaneRouteId, wire::kLaneLinksId};
  return part < wire::kFirstPointPart ? kIds[part] : wire::kLanePointId;
}

}  // namespace

bool MapHead::take(const wire::Frame& frame) {
  if (frame.id != wire::kMapHeaderId && frame.id != wire::kMapSlotsId) return false;
  if (!wire::e2e_crc_fits(frame)) return true;
  wire::MapHeader header;
  wire::MapSlots slots;
  if (wire::decode(frame, header)) {
    before_ = frames_[0];
    frames_[0] = frame;
    seen_ |= 1U;
    conflict_count_ = header.conflict_count;
    digest_ = header.digest;
  } else if (wire::decode(frame, slots)) {
    frames_[1 + slots.half] = frame;
    seen_ |= 2U << slots.half;
    lanes_[slots.half] = slots.in_use;
  }
  return true;
}

bool MapHead::said_before() const {
  constexpr unsigned kBehindCounter = 0xF0;
  wire::E2eReceiver receiver;
  static_cast<void>(receiver.check(before_));
  bool same = receiver.check(frames_[0]) == wire::E2eState::kOk &&
              (before_.data[1] & kBehindCounter) == (frames_[0].data[1] & kBehindCounter);
  for (int i = 2; i < 8; ++i) same = same && before_.data[i] == frames_[0].data[i];
  return same;
}

bool MapHead::in_use(int record) const {
  if (record < wire::kMaxLanes) return wire::contains(lanes_, record);
  return record - wire::kMaxLanes < conflict_count_;
}

bool find_place(const wire::Frame& frame, RecordPlace& place) {
  if (!wire::e2e_crc_fits(frame)) return false;
  switch (frame.id) {
    case wire::kLaneHeaderId: {
      wire::LaneHeader header;
      if (!find_lane_part(frame, wire::kLaneHeaderPart, place, header)) return false;
      place.parts = wire::kFirstPointPart + header.point_count;
      return true;
    }
    case wire::kLaneRouteId: {
      wire::LaneRoute route;
      return find_lane_part(frame, wire::kLaneRoutePart, place, route);
    }
    case wire::kLaneLinksId: {
      wire::LaneLinks links;
      return find_lane_part(frame, wire::kLaneLinksPart, place, links);
    }
    case wire::kLanePointId: {
      wire::LanePoint point;
      if (!find_lane_part(frame, wire::kFirstPointPart, place, point)) return false;
      place.part += point.index;
      return true;
    }
    case wire::kConflictFirstId:
      return find_conflict_part<wire::ConflictFirst>(frame, 0, place);
    case wire::kConflictSecondId:
      return find_conflict_part<wire::ConflictSecond>(frame, 1, place);
    default:
      return false;
  }
}

std::uint8_t (&MapRecords::at(int record, int part))[8] {
  return record < wire::kMaxLanes ? lanes_[record][part] : conflicts_[record - wire::kMaxLanes][part];
}
const std::uint8_t (&MapRecords::at(int record, int part) const)[8] {
  return record < wire::kMaxLanes ? lanes_[record][part] : conflicts_[record - wire::kMaxLanes][part];
}

wire::Frame MapRecords::frame(int record, int part) const {
  wire::Frame frame;
  frame.id = id_of(record, part);
  frame.length = 8;
  for (int i = 0; i < 8; ++i) frame.data[i] = at(record, part)[i];
  return frame;
}

bool MapRecords::has(const wire::Frame& frame, const RecordPlace& place) const {
  if ((states_[place.record].there >> place.part & 1U) == 0U) return false;
  for (int i = 0; i < 8; ++i) {
    if (at(place.record, place.part)[i] != frame.data[i]) return false;
  }
  return true;
}

bool MapRecords::take(const wire::Frame& frame, const RecordPlace& place) {
  if (has(frame, place)) return false;
  State& state = states_[place.record];
  if (state.revision != place.revision) {
    state = State{};
    state.revision = place.revision;
  }
  if (place.parts > 0) state.parts = static_cast<std::uint8_t>(place.parts);
  for (int i = 0; i < 8; ++i) at(place.record, place.part)[i] = frame.data[i];
  state.there = static_cast<std::uint16_t>(state.there | 1U << place.part);
  state.checked = state.tagged = false;
  return true;
}

bool MapRecords::complete(int record) const {
  const State& state = states_[record];
  const unsigned all = (1U << state.parts) - 1U;
  return state.parts > 0 && (state.there & all) == all;
}

std::uint16_t MapRecords::check(int record) {
  State& state = states_[record];
  if (state.checked) return state.check;
  unsigned sum = 0;
  for (int part = 0; part < state.parts; ++part) sum += wire::frame_check(frame(record, part));
  state.check = static_cast<std::uint16_t>(sum);
  state.checked = true;
  return state.check;
}

bool MapRecords::same(int record, const MapRecords& other) const {
  const State& mine = states_[record];
  const State& theirs = other.states_[record];
  if (mine.parts != theirs.parts || mine.revision != theirs.revision) return false;
  for (int part = 0; part < mine.parts; ++part) {
    for (int i = 0; i < 8; ++i) {
      if (at(record, part)[i] != other.at(record, part)[i]) return false;
    }
  }
  return true;
}

void MapRecords::copy(int record, const MapRecords& from) {
  states_[record] = from.states_[record];
  for (int part = 0; part < parts(record); ++part) {
    for (int i = 0; i < 8; ++i) at(record, part)[i] = from.at(record, part)[i];
  }
}

bool MapRecords::whole(const MapHead& head) {
  if (!head.whole()) return false;
  unsigned sum = 0;
  for (int record = 0; record < kRecords; ++record) {
    if (!head.in_use(record)) continue;
    if (!complete(record)) return false;
    sum += check(record);
  }
  return static_cast<std::uint16_t>(sum) == head.digest();
}

bool MapRecords::make_tag(int record, hal::Authenticator& keys) {
  State& state = states_[record];
  if (state.tagged) return true;
  std::uint8_t bytes[2 + 8 * wire::kMaxLaneParts] = {kTagLabel, static_cast<std::uint8_t>(record)};
  std::uint32_t size = 2;
  for (int part = 0; part < state.parts; ++part) {
    for (const std::uint8_t byte : at(record, part)) bytes[size++] = byte;
  }
  std::uint8_t mac[hal::kCmacBytes] = {};
  state.tagged = keys.cmac(hal::KeySlot::kLongTerm, bytes, size, mac);
  for (int i = 0; i < kTagBytes; ++i) state.tag[i] = mac[i];
  return state.tagged;
}

bool MapRecords::add_to(Message& message, const MapHead& head, hal::Authenticator& keys) {
  for (int i = 0; i < MapHead::kFrames; ++i) message.add(head.frame(i));
  for (int record = 0; record < kRecords; ++record) {
    if (!head.in_use(record)) continue;
    if (!make_tag(record, keys)) return false;
    message.add_byte(static_cast<std::uint8_t>(record));
    message.add(states_[record].tag, kTagBytes);
  }
  return true;
}

}  // namespace s4tp::secoc
