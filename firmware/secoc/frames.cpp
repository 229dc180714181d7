#include "firmware/secoc/frames.hpp"

#include "firmware/wire/codec.hpp"
#include "firmware/wire/e2e.hpp"

namespace s4tp::secoc {
namespace {

constexpr unsigned kHalfNonceBits = 20;

template <class Auth>
bool read(const wire::Frame& frame, Companion& companion) {
  Auth auth;
  if (!wire::decode(frame, auth)) return false;
  companion.mac = static_cast<std::uint64_t>(auth.mac_high) << 32U | auth.mac_low;
  companion.freshness = auth.freshness;
  return true;
}

template <class Auth>
wire::Frame written(const Companion& companion) {
  Auth auth;
  auth.mac_low = static_cast<std::uint32_t>(companion.mac & 0xFFFFFFFFU);
  auth.mac_high = static_cast<std::uint16_t>(companion.mac >> 32U);
  auth.freshness = companion.freshness;
  wire::Frame frame;
  static_cast<void>(wire::encode(auth, frame));  // every value fits
  return frame;
}

template <class NonceOf>
bool read_from(const wire::Frame& frame, Nonce& nonce) {
  NonceOf message;
  if (!wire::e2e_crc_fits(frame) || !wire::decode(frame, message)) return false;
  nonce.value = static_cast<std::uint64_t>(message.nonce_high) << kHalfNonceBits | message.nonce_low;
  nonce.request = message.request != 0;
  return true;
}

template <class NonceOf>
wire::Frame written_to(const Nonce& nonce) {
  NonceOf message;
  message.request = nonce.request ? 1 : 0;
  message.nonce_low = static_cast<std::uint32_t>(nonce.value & ((1U << kHalfNonceBits) - 1U));
  message.nonce_high = static_cast<std::uint32_t>(nonce.value >> kHalfNonceBits);
  wire::Frame frame;
  static_cast<void>(wire::encode(message, frame));  // every value fits
  wire::e2e_seal(frame);
  return frame;
}

}  // namespace

bool is_member(std::uint32_t id) {
  return id == wire::kTrackPoseId || id == wire::kTrackMotionId;
}
bool is_motion(std::uint32_t id) {
  return id == wire::kMotionId || id == wire::kSteeringId || id == wire::kPoseId;
}
bool is_map(std::uint32_t id) {
  return id >= wire::kMapHeaderId && id <= wire::kConflictSecondId;
}
bool begins(std::uint32_t id) {
  return id == wire::kCommandId || id == wire::kMotionId || id == wire::kTrackListId;
}

bool find_group(std::uint32_t id, Group& group) {
  if (id == wire::kCommandId) {
    group = Group::kCommand;
  } else if (is_motion(id)) {
    group = Group::kMotion;
  } else if (id == wire::kTrackListId || is_member(id)) {
    group = Group::kTracks;
  } else if (is_map(id)) {
    group = Group::kMap;
  } else {
    return false;
  }
  return true;
}

bool read_companion(const wire::Frame& frame, Group& group, Companion& companion) {
  if (read<wire::CommandAuth>(frame, companion)) {
    group = Group::kCommand;
  } else if (read<wire::MotionAuth>(frame, companion)) {
    group = Group::kMotion;
  } else if (read<wire::TrackListAuth>(frame, companion)) {
    group = Group::kTracks;
  } else if (read<wire::MapAuth>(frame, companion)) {
    group = Group::kMap;
  } else {
    return false;
  }
  return true;
}

wire::Frame write_companion(Group group, const Companion& companion) {
  switch (group) {
    case Group::kCommand:
      return written<wire::CommandAuth>(companion);
    case Group::kMotion:
      return written<wire::MotionAuth>(companion);
    case Group::kTracks:
      return written<wire::TrackListAuth>(companion);
    default:
      return written<wire::MapAuth>(companion);
  }
}

bool read_nonce(const wire::Frame& frame, End sender, Nonce& nonce) {
  return sender == End::kEcu ? read_from<wire::NonceEcu>(frame, nonce)
                             : read_from<wire::NonceWorld>(frame, nonce);
}

wire::Frame write_nonce(End sender, const Nonce& nonce) {
  return sender == End::kEcu ? written_to<wire::NonceEcu>(nonce) : written_to<wire::NonceWorld>(nonce);
}

}  // namespace s4tp::secoc
