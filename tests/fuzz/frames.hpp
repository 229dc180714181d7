#pragma once
/// Frames out of a fuzzer's bytes: protected, so that they get past the checks to what is behind them.

#include <iterator>

#include "firmware/wire/codec.hpp"
#include "firmware/wire/e2e.hpp"
#include "firmware/wire/track_list.hpp"
#include "tests/fuzz/input.hpp"

namespace s4tp::fuzz {

/// Members of lists have a generation or revision where other messages have their counter.
inline bool has_counter(std::uint32_t id) {
  return id != wire::kTrackPoseId && id != wire::kTrackMotionId &&
         (id < wire::kMapSlotsId || id > wire::kConflictSecondId);
}

/// The newest counter of each message of ours, by its place in kMessages.
struct Counters {
  std::uint8_t next[std::size(wire::kMessages)] = {};
};

/// A frame of one of our messages, seldom of another id. Mostly its CRC fits and its counter is one further.
inline wire::Frame take_frame(Input& input, Counters& counters) {
  wire::Frame frame;
  const int how = input.byte();
  const int message = input.below(static_cast<int>(std::size(wire::kMessages)));
  frame.id = wire::kMessages[message].id;
  frame.length = 8;
  input.copy(frame.data, sizeof frame.data);
  if (how % 16 == 15) frame.length = input.byte();
  if (how % 32 == 14) frame.id = input.take<std::uint32_t>();
  if (how % 4 != 3 && has_counter(wire::kMessages[message].id)) {
    std::uint8_t& counter = counters.next[message];
    frame.data[1] = static_cast<std::uint8_t>((frame.data[1] & 0xF0U) | counter);
    counter = static_cast<std::uint8_t>((counter + 1) % 15);
  }
  if (how < 224) wire::e2e_seal(frame);
  return frame;
}

/// Any number of tracks, all within the wire's ranges.
inline void take_tracks(Input& input, wire::Tracks& tracks) {
  tracks.count = static_cast<std::uint8_t>(input.below(wire::kMaxTracks + 1));
  for (int i = 0; i < tracks.count; ++i) {
    tracks.items[i] = {input.byte(),
                       input.real(-1310.0F, 1310.0F),
                       input.real(-1310.0F, 1310.0F),
                       input.real(-3.1F, 3.1F),
                       input.real(0.0F, 60.0F),
                       input.real(-12.0F, 12.0F),
                       input.real(-1.2F, 1.2F),
                       input.real(0.0F, 25.0F),
                       input.real(0.0F, 3.0F)};
  }
}

}  // namespace s4tp::fuzz
