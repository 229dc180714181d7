#include "firmware/wire/track_list.hpp"

#include "firmware/wire/codec.hpp"
#include "firmware/wire/crc16.hpp"

namespace s4tp::wire {
namespace {

constexpr unsigned kGenerations = 16;
constexpr std::uint8_t kLeftOutMax = 31;

bool encode_pose(const Track& track, std::uint8_t generation, int index, Frame& frame) {
  TrackPose pose;
  pose.generation = generation;
  pose.index = static_cast<std::uint8_t>(index);
  pose.x_m = track.x_m;
  pose.y_m = track.y_m;
  pose.heading_rad = track.heading_rad;
  return encode(pose, frame);
}

bool encode_motion(const Track& track, std::uint8_t generation, int index, Frame& frame) {
  TrackMotion motion;
  motion.generation = generation;
  motion.index = static_cast<std::uint8_t>(index);
  motion.id = track.id;
  motion.speed_mps = track.speed_mps;
  motion.acceleration_mps2 = track.acceleration_mps2;
  motion.yaw_rate_radps = track.yaw_rate_radps;
  motion.length_m = track.length_m;
  motion.width_m = track.width_m;
  return encode(motion, frame);
}

bool encodable(const Track& track) {
  Frame frame;
  return encode_pose(track, 0, 0, frame) && encode_motion(track, 0, 0, frame);
}

void keep(const Frame& frame, std::uint8_t (&kept)[8]) {
  for (int i = 0; i < 8; ++i) kept[i] = frame.data[i];
}

bool same(const Frame& frame, const std::uint8_t (&kept)[8]) {
  for (int i = 0; i < 8; ++i) {
    if (frame.data[i] != kept[i]) return false;
  }
  return true;
}

void count_up(std::uint16_t& counter) {
  if (counter < UINT16_MAX) ++counter;
}

}  // namespace

std::uint16_t list_digest(const TrackMembers& members, int count) {
  std::uint16_t crc = kCrc16Start;
  for (int i = 0; i < count; ++i) {
    for (const std::uint8_t byte : members.poses[i]) crc = crc16_add(crc, byte);
    for (const std::uint8_t byte : members.motions[i]) crc = crc16_add(crc, byte);
  }
  return crc;
}

void TrackListSender::start(const Tracks& tracks) {
  tracks_.vehicle_time_ms = tracks.vehicle_time_ms;
  tracks_.count = 0;
  unsigned left_out = tracks.left_out;
  for (int i = 0; i < tracks.count && i < kMaxTracks; ++i) {
    if (encodable(tracks.items[i])) {
      tracks_.items[tracks_.count++] = tracks.items[i];
    } else {
      ++left_out;
    }
  }
  tracks_.left_out = left_out < kLeftOutMax ? static_cast<std::uint8_t>(left_out) : kLeftOutMax;
  generation_ = static_cast<std::uint8_t>((generation_ + 1U) % kGenerations);
  sent_ = 0;
  total_ = 1 + 2 * tracks_.count;
}

bool TrackListSender::next(Frame& frame) {
  if (sent_ >= total_) return false;
  const int part = sent_++;
  if (part == 0) {
    TrackList list;
    list.generation = generation_;
    list.count = tracks_.count;
    list.left_out = tracks_.left_out;
    list.vehicle_time_ms = tracks_.vehicle_time_ms;
    TrackMembers members;
    for (int i = 0; i < tracks_.count; ++i) {
      Frame member;
      if (!seal_member(1 + 2 * i, member)) return false;
      keep(member, members.poses[i]);
      if (!seal_member(2 + 2 * i, member)) return false;
      keep(member, members.motions[i]);
    }
    list.digest = list_digest(members, tracks_.count);
    if (!encode(list, frame)) return false;
    header_.protect(frame);
    return true;
  }
  return seal_member(part, frame);
}

bool TrackListSender::seal_member(int part, Frame& frame) const {
  const int index = (part - 1) / 2;
  const Track& track = tracks_.items[index];
  const bool encoded = part % 2 == 1 ? encode_pose(track, generation_, index, frame)
                                     : encode_motion(track, generation_, index, frame);
  if (encoded) e2e_seal(frame);
  return encoded;
}

bool TrackListReceiver::accept(const Frame& frame) {
  switch (frame.id) {
    case kTrackListId:
      return accept_header(frame);
    case kTrackPoseId:
      return accept_pose(frame);
    case kTrackMotionId:
      return accept_motion(frame);
    default:
      return false;
  }
}

void TrackListReceiver::nothing_arrived() {
  static_cast<void>(header_.nothing_arrived());
  give_up();
}

bool TrackListReceiver::accept_header(const Frame& frame) {
  const E2eState state = header_.check(frame);
  if (state == E2eState::kRepeated) return false;
  if (state == E2eState::kWrongCrc) {
    reject();
    return false;
  }
  // Whatever this one is worth, the list before it is over.
  give_up();
  if (state == E2eState::kInitial) return false;
  TrackList list;
  if (!E2eReceiver::trusted(state) || !decode(frame, list)) {
    reject();
    return false;
  }
  begun_ = true;
  generation_ = list.generation;
  poses_ = 0;
  motions_ = 0;
  assembling_ = Tracks{};
  assembling_.vehicle_time_ms = list.vehicle_time_ms;
  assembling_.count = list.count;
  assembling_.left_out = list.left_out;
  digest_ = list.digest;
  return finish_if_whole();
}

bool TrackListReceiver::accept_pose(const Frame& frame) {
  TrackPose pose;
  if (!e2e_crc_fits(frame) || !decode(frame, pose)) {
    reject();
    return false;
  }
  if (!awaits(pose.generation, pose.index)) return false;
  if (!is_new(frame, poses_, pose.index, members_.poses[pose.index])) return false;
  Track& track = assembling_.items[pose.index];
  track.x_m = pose.x_m;
  track.y_m = pose.y_m;
  track.heading_rad = pose.heading_rad;
  return finish_if_whole();
}

bool TrackListReceiver::accept_motion(const Frame& frame) {
  TrackMotion motion;
  if (!e2e_crc_fits(frame) || !decode(frame, motion)) {
    reject();
    return false;
  }
  if (!awaits(motion.generation, motion.index)) return false;
  if (!is_new(frame, motions_, motion.index, members_.motions[motion.index])) return false;
  Track& track = assembling_.items[motion.index];
  track.id = motion.id;
  track.speed_mps = motion.speed_mps;
  track.acceleration_mps2 = motion.acceleration_mps2;
  track.yaw_rate_radps = motion.yaw_rate_radps;
  track.length_m = motion.length_m;
  track.width_m = motion.width_m;
  return finish_if_whole();
}

/// Whether a member belongs to the list begun. A member of a later generation ends that list: its own header
/// was lost.
bool TrackListReceiver::awaits(std::uint8_t generation, std::uint8_t index) {
  if (!begun_) return false;
  const unsigned ahead = (kGenerations + generation - generation_) % kGenerations;
  if (ahead > 0U && ahead <= kGenerations / 2U) give_up();
  if (ahead == 0U && index < assembling_.count) return true;
  reject();
  return false;
}

bool TrackListReceiver::is_new(const Frame& frame, std::uint16_t& arrived, unsigned index,
                               std::uint8_t (&kept)[8]) {
  const auto bit = static_cast<std::uint16_t>(1U << index);
  if ((arrived & bit) != 0U) {
    if (!same(frame, kept)) make_void();
    return false;
  }
  arrived |= bit;
  keep(frame, kept);
  return true;
}

bool TrackListReceiver::finish_if_whole() {
  const auto all = static_cast<std::uint16_t>((1UL << assembling_.count) - 1U);
  if (poses_ != all || motions_ != all) return false;
  if (list_digest(members_, assembling_.count) != digest_) {
    make_void();
    return false;
  }
  whole_ = assembling_;
  begun_ = false;
  return true;
}

void TrackListReceiver::give_up() {
  if (begun_) count_up(broken_);
  begun_ = false;
}

void TrackListReceiver::make_void() {
  count_up(voided_);
  begun_ = false;
  reject();
}

void TrackListReceiver::reject() {
  count_up(rejected_);
}

}  // namespace s4tp::wire
