// Frames as receivers see them: protection, codec, track list. Lists that lose, repeat or mix up frames arrive as they were
// sent, or not at all.

#include <algorithm>
#include <iterator>
#include <vector>

#include "firmware/wire/track_list.hpp"
#include "tests/fuzz/frames.hpp"
#include "tests/support/wire_samples.hpp"

using namespace s4tp;
using fuzz::expect;
using fuzz::Input;

namespace {

bool same(const wire::Frame& a, const wire::Frame& b) {
  return a.id == b.id && a.length == b.length && std::memcmp(a.data, b.data, sizeof a.data) == 0;
}

/// What is read is written and read again the same; what can be written of any numbers can be read.
template <class Message>
void round_trip(const wire::Frame& frame, Input& input, bool any_numbers) {
  Message message;
  wire::Frame written;
  if (wire::decode(frame, message)) {
    expect(wire::encode(message, written), "what was decoded can be encoded");
    Message again;
    wire::Frame twice;
    expect(wire::decode(written, again) && wire::encode(again, twice) && same(written, twice),
           "and is the same then");
  }
  if (!any_numbers) return;
  input.copy(&message, sizeof message);
  if (wire::encode(message, written))
    expect(wire::decode(written, message), "what was encoded can be decoded");
}

template <class... Messages>
void round_trips(const wire::Frame& frame, Input& input) {
  const auto chosen = static_cast<std::size_t>(input.byte());
  std::size_t index = 0;
  (round_trip<Messages>(frame, input, index++ == chosen), ...);
}

void codec(const wire::Frame& frame, Input& input) {
  round_trips<wire::Command, wire::Motion, wire::Steering, wire::Pose, wire::Tick, wire::TrackList,
              wire::TrackPose, wire::TrackMotion, wire::MapHeader, wire::MapSlots, wire::LaneHeader,
              wire::LaneRoute, wire::LaneLinks, wire::LanePoint, wire::ConflictFirst, wire::ConflictSecond,
              wire::MapOrigin, wire::VersionWorld, wire::VersionEcu, wire::EcuStatus, wire::CycleStatistics,
              wire::PlanDigest, wire::PlanReason>(frame, input);
  expect(wire::message_name(frame.id) != nullptr, "every id has a name, if only ?");
}

bool within(float value, float limit) {
  return value >= -limit && value <= limit;
}

void check(const wire::Tracks& tracks) {
  expect(tracks.count <= wire::kMaxTracks, "no more tracks than a list holds");
  for (int i = 0; i < tracks.count; ++i) {
    const wire::Track& track = tracks.items[i];
    expect(within(track.x_m, 1311.0F) && within(track.y_m, 1311.0F) && within(track.heading_rad, 3.1416F) &&
               within(track.speed_mps, 60.01F) && within(track.acceleration_mps2, 12.81F) &&
               within(track.yaw_rate_radps, 1.29F) && within(track.length_m, 25.6F) &&
               within(track.width_m, 3.11F),
           "a track's values are in the wire's ranges");
  }
}

/// The same but for the steps of the wire.
bool alike(const wire::Tracks& a, const wire::Tracks& b) {
  if (a.vehicle_time_ms != b.vehicle_time_ms || a.count != b.count) return false;
  for (int i = 0; i < a.count; ++i) {
    const wire::Track& one = a.items[i];
    const wire::Track& other = b.items[i];
    const bool like =
        one.id == other.id && within(one.x_m - other.x_m, 0.006F) && within(one.y_m - other.y_m, 0.006F) &&
        within(one.heading_rad - other.heading_rad, 0.001F) &&
        within(one.speed_mps - other.speed_mps, 0.031F) &&
        within(one.acceleration_mps2 - other.acceleration_mps2, 0.051F) &&
        within(one.yaw_rate_radps - other.yaw_rate_radps, 0.006F) &&
        within(one.length_m - other.length_m, 0.051F) && within(one.width_m - other.width_m, 0.051F);
    if (!like) return false;
  }
  return true;
}

/// A list's frames, whole or with some lost, repeated or exchanged.
std::vector<wire::Frame> take_list(Input& input, wire::TrackListSender& sender, const wire::Tracks& tracks) {
  std::vector<wire::Frame> frames = wire::frames_of(sender, tracks);
  for (int wounds = input.below(4); wounds > 0 && !frames.empty(); --wounds) {
    const std::size_t at = input.byte() % frames.size();
    const std::size_t other = input.byte() % frames.size();
    switch (input.below(3)) {
      case 0:
        frames.erase(frames.begin() + static_cast<std::ptrdiff_t>(at));
        break;
      case 1:
        frames.insert(frames.begin() + static_cast<std::ptrdiff_t>(at), wire::Frame(frames[other]));
        break;
      default:
        std::swap(frames[at], frames[other]);
    }
  }
  return frames;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Input input(data, size);
  fuzz::Counters counters;
  wire::E2eReceiver protections[std::size(wire::kMessages)];
  wire::TrackListReceiver disturbed;  // by frames of the fuzzer's own, too
  wire::TrackListReceiver receiver;
  wire::TrackListSender sender;
  std::vector<wire::Tracks> sent;
  while (!input.empty()) {
    const int what = input.below(8);
    if (what == 0) {
      receiver.nothing_arrived();
      disturbed.nothing_arrived();
      for (wire::E2eReceiver& protection : protections) static_cast<void>(protection.nothing_arrived());
    } else if (what < 3) {
      wire::Tracks& tracks = sent.emplace_back();
      tracks.vehicle_time_ms = input.take<std::uint16_t>();
      take_tracks(input, tracks);
      for (const wire::Frame& frame : take_list(input, sender, sent.back())) {
        if (disturbed.accept(frame)) check(disturbed.tracks());
        if (!receiver.accept(frame)) continue;
        check(receiver.tracks());
        const auto like_it = [&](const wire::Tracks& tracks) { return alike(tracks, receiver.tracks()); };
        expect(std::any_of(sent.rbegin(), sent.rend(), like_it), "a list is one that was sent");
      }
    } else {
      const wire::Frame frame = fuzz::take_frame(input, counters);
      for (std::size_t i = 0; i < std::size(wire::kMessages); ++i) {
        if (frame.id != wire::kMessages[i].id) continue;
        const wire::E2eState state = protections[i].check(frame);
        expect(!wire::E2eReceiver::trusted(state) || wire::e2e_crc_fits(frame),
               "what is trusted is undamaged");
        expect(state == protections[i].state(), "the state is the one answered");
      }
      codec(frame, input);
      if (disturbed.accept(frame)) check(disturbed.tracks());
    }
  }
  return 0;
}
