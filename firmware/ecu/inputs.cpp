#include "firmware/ecu/inputs.hpp"

#include "algo/core/input_ranges.hpp"
#include "algo/core/math.hpp"
#include "firmware/wire/version.hpp"

namespace s4tp::ecu {
namespace {

constexpr std::int32_t kListAgeMaxMs = 1000;
constexpr std::uint32_t kMapAgeMaxMs = 5000;
constexpr std::int32_t kIntervalMinMs = 8;
constexpr std::int32_t kIntervalMaxMs = 12;
constexpr float kSecondsPerMs = 0.001F;
static_assert(kListLeadS == wire::kListLeadS, "senders cut lists as the guard expects");

Track to_track(const wire::Track& from) {
  Track to;
  to.id = from.id;
  to.centre = {from.x_m, from.y_m, from.heading_rad};
  to.speed_mps = from.speed_mps;
  to.acceleration_mps2 = from.acceleration_mps2;
  to.yaw_rate_radps = from.yaw_rate_radps;
  to.length_m = from.length_m;
  to.width_m = from.width_m;
  return limited(to);
}

}  // namespace

bool Silence::period_missed() {
  ++ticks_;  // the tick in which a frame came counts as the first
  if (ticks_ <= period_ticks_ + period_ticks_ / 2) return false;
  ticks_ = static_cast<std::uint16_t>(ticks_ - period_ticks_);
  return true;
}

bool PeriodicReceiver::trusts(const wire::Frame& frame) {
  silence_.heard();
  return wire::E2eReceiver::trusted(receiver_.check(frame));
}

void PeriodicReceiver::tick() {
  if (silence_.period_missed()) static_cast<void>(receiver_.nothing_arrived());
}

void Inputs::accept(const wire::Frame& frame) {
  ++accepted_;
  switch (frame.id) {
    case wire::kMotionId:
      return accept_motion(frame);
    case wire::kSteeringId:
      return accept_steering(frame);
    case wire::kPoseId:
      return accept_pose(frame);
    case wire::kTickId: {
      wire::Tick tick;
      const bool taken = tick_receiver_.trusts(frame) && wire::decode(frame, tick);
      if (taken) {
        tick_number_ = tick.tick;
      } else {
        ++rejected_;
      }
      return;
    }
    case wire::kTrackListId:
    case wire::kTrackPoseId:
    case wire::kTrackMotionId:
      return accept_tracks(frame);
    case wire::kVersionWorldId:
      return accept_version(frame);
    default:
      if (frame.id >= wire::kMapHeaderId && frame.id <= wire::kConflictSecondId) accept_map(frame);
  }
}

void Inputs::accept_motion(const wire::Frame& frame) {
  wire::Motion motion;
  if (!motion_receiver_.trusts(frame) || !wire::decode(frame, motion)) {
    ++rejected_;
    return;
  }
  const std::int32_t interval_ms = clock_.update(motion.vehicle_time_ms);
  const bool timely = interval_ms >= kIntervalMinMs && interval_ms <= kIntervalMaxMs;
  motion_mistimed_ticks_ = timely ? 0 : motion_mistimed_ticks_ + 1;
  ego_.speed_mps = limited(motion.speed_mps, kEgoSpeedMps);
  ego_.acceleration_mps2 = limited(motion.acceleration_mps2, kEgoAccelerationMps2);
  ego_.yaw_rate_radps = limited(motion.yaw_rate_radps, kEgoYawRateRadps);
  measured_.speed_mps = motion.speed_mps;
  measured_.acceleration_mps2 = motion.acceleration_mps2;
  measured_.yaw_rate_radps = motion.yaw_rate_radps;
  motion_new_ = true;
  motion_seen_ = true;
}

void Inputs::accept_steering(const wire::Frame& frame) {
  wire::Steering steering;
  if (!steering_receiver_.trusts(frame) || !wire::decode(frame, steering)) {
    ++rejected_;
    return;
  }
  ego_.steering_rad = limited(steering.steering_rad, kEgoSteeringRad);
  measured_.steering_rad = steering.steering_rad;
  engage_ = steering.engage != 0;
  driver_override_ = steering.driver_override != 0;
  steering_new_ = true;
}

void Inputs::accept_pose(const wire::Frame& frame) {
  if (!pose_receiver_.trusts(frame) || !wire::decode(frame, pose_)) {
    ++rejected_;
    return;
  }
  pose_new_ = true;
}

void Inputs::accept_tracks(const wire::Frame& frame) {
  if (frame.id == wire::kTrackListId) list_silence_.heard();
  if (track_receiver_.accept(frame)) tracks_new_ = true;
}

void Inputs::accept_map(const wire::Frame& frame) {
  const std::uint16_t rejected = map_receiver_.rejected_frames();
  const bool whole = map_receiver_.accept(frame);
  if (whole) {
    ++map_revision_;
    map_confirmed_ = true;
  }
  if (frame.id != wire::kMapHeaderId || map_receiver_.rejected_frames() != rejected) return;
  map_silence_.heard();
  // A repeated header is no news of the map, whatever the one before said.
  const auto counter = static_cast<std::uint8_t>(frame.data[1] & 0x0FU);
  if (counter != map_counter_ && map_receiver_.confirmed()) map_confirmed_ = true;
  map_counter_ = counter;
}

void Inputs::accept_version(const wire::Frame& frame) {
  wire::VersionWorld version;
  if (!version_receiver_.trusts(frame) || !wire::decode(frame, version)) {
    ++rejected_;
    return;
  }
  const bool fits =
      version.wire_version == wire::wire_version() && version.layout_hash == wire::layout_hash();
  version_ = fits ? Version::kFits : Version::kDiffers;
}

void Inputs::close_tick() {
  if (motion_new_) {
    motion_missing_ticks_ = 0;
  } else {
    clock_.coast();
    if (motion_missing_ticks_ != kNeverMs) ++motion_missing_ticks_;
  }
  const std::uint32_t passed_ms = clock_.now_ms() - last_close_ms_;
  last_close_ms_ = clock_.now_ms();
  Age* const ages[] = {&pose_age_, &steering_age_, &tracks_age_, &map_age_};
  for (Age* const age : ages) age->pass(passed_ms);
  if (pose_new_) {
    ego_.rear_axle = {pose_.x_m, pose_.y_m, wrap_angle(pose_.heading_rad)};
    move_ego(pose_.age_10ms * 10U);
    pose_age_.renew();
  } else {
    move_ego(passed_ms);
  }
  if (steering_new_) steering_age_.renew();
  if (tracks_new_) take_tracks();
  if (map_confirmed_) map_age_.renew();

  measured_.passed_ms = passed_ms;
  measured_.rear_axle = ego_.rear_axle;
  measured_.known = ego_known() && steering_age_.known();
  measured_.motion = motion_new_;
  measured_.pose = pose_new_;

  motion_receiver_.tick();
  steering_receiver_.tick();
  pose_receiver_.tick();
  tick_receiver_.tick();
  version_receiver_.tick();
  if (list_silence_.period_missed()) track_receiver_.nothing_arrived();
  if (map_silence_.period_missed()) map_receiver_.nothing_arrived();
  motion_new_ = pose_new_ = steering_new_ = tracks_new_ = map_confirmed_ = false;
}

void Inputs::take_tracks() {
  const wire::Tracks& list = track_receiver_.tracks();
  const std::uint32_t list_ms = clock_.extend(list.vehicle_time_ms);
  const std::int32_t age_ms = elapsed_ms(list_ms, clock_.now_ms());
  const bool plausible = age_ms >= -static_cast<std::int32_t>(kTickMs) && age_ms < kListAgeMaxMs;
  const bool newer = !tracks_age_.known() || elapsed_ms(tracks_ms_, list_ms) > 0;
  if (!clock_.started() || !plausible || !newer) {
    ++rejected_;
    return;
  }
  tracks_.clear();
  for (int i = 0; i < list.count; ++i) static_cast<void>(tracks_.push(to_track(list.items[i])));
  tracks_.left_out = list.left_out;
  tracks_ms_ = list_ms;
  tracks_age_.renew();
}

void Inputs::move_ego(std::uint32_t duration_ms) {
  const float duration_s = static_cast<float>(duration_ms) * kSecondsPerMs;
  const float turned_rad = ego_.yaw_rate_radps * duration_s;
  const float middle_rad = ego_.rear_axle.heading_rad + 0.5F * turned_rad;
  const float mean_mps = max(0.0F, ego_.speed_mps - 0.5F * ego_.acceleration_mps2 * duration_s);
  const float way_m = mean_mps * duration_s;
  ego_.rear_axle.x_m += way_m * cos(middle_rad);
  ego_.rear_axle.y_m += way_m * sin(middle_rad);
  ego_.rear_axle.heading_rad = wrap_angle(ego_.rear_axle.heading_rad + turned_rad);
}

const wire::Map* Inputs::map() const {
  return map_age_.ms() >= kMapAgeMaxMs ? nullptr : &map_receiver_.map();
}

std::uint32_t Inputs::rejected_frames() const {
  return rejected_ + track_receiver_.rejected_frames() + map_receiver_.rejected_frames();
}

void Inputs::observe(Observations& observed) const {
  observed.motion_missing_ticks = motion_missing_ticks_;
  observed.motion_mistimed_ticks = motion_mistimed_ticks_;
  observed.pose_age_ms = pose_age_.ms();
  observed.steering_age_ms = steering_age_.ms();
  observed.tracks_age_ms = tracks_age_.ms();
  observed.map_age_ms = map_age_.ms();
  observed.version_mismatch = version_ == Version::kDiffers;
  observed.driver_override = driver_override_;
}

}  // namespace s4tp::ecu
