#pragma once
/// Tests of the bus decorator of firmware/secoc: two ends in a session, and what the ECU hands on of what it hears.

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "firmware/secoc/frames.hpp"
#include "firmware/wire/lane_map.hpp"
#include "firmware/wire/track_list.hpp"
#include "tests/support/secoc_rig.hpp"

namespace s4tp::secoc {

using Frames = std::vector<wire::Frame>;

/// A rig with a session.
struct SecocCan : testing::Test {
  SecocCan() { EXPECT_GE(rig.until_both_ways(), 0); }

  /// What the world's end puts on the bus for these frames, without its reaching the ECU.
  Frames on_the_bus(const Frames& frames) {
    rig.wire.seen.clear();
    rig.wire.lost = [](const wire::Frame&) { return true; };
    for (const wire::Frame& frame : frames) rig.world.send(frame);
    put_tick();
    rig.wire.lost = nullptr;
    return rig.wire.seen;
  }
  void put_tick() { SecocRig::put(rig.world, wire::Tick{}, rig.tick_sender); }
  /// What the ECU gets of these frames.
  Frames reaches_ecu(const Frames& frames) {
    for (const wire::Frame& frame : frames) rig.inject(frame);
    return rig.ecu.take();
  }
  /// The same without what is not protected.
  static Frames protected_ones(Frames frames) {
    std::erase_if(frames, [](const wire::Frame& frame) { return frame.id == wire::kTickId; });
    return frames;
  }
  /// Header and members of a list whose every value depends on the seed.
  Frames list(int tracks, int seed) { return wire::frames_of(lists, wire::sample_tracks(tracks, seed)); }

  SecocRig rig;
  wire::TrackListSender lists;
};

/// A map node, and the map as the application receives it.
struct SecocMap : SecocCan {
  SecocMap() { maps.update(map); }

  /// A tick of the map node. \return whether a new whole map has come out
  bool tick() {
    for (const wire::Frame& frame : wire::frames_of(maps, now_ms, 10)) rig.world.send(frame);
    put_tick();
    now_ms += 10;
    const bool whole = take();
    (void)rig.tick();
    return whole;
  }
  bool take() {
    bool whole = false;
    for (const wire::Frame& frame : rig.ecu.take()) {
      if (is_map(frame.id)) taken.push_back(frame);
      whole = receiver.accept(frame) || whole;
    }
    return whole;
  }
  int until_whole(int limit = 600) {
    for (int i = 0; i < limit; ++i) {
      if (tick()) return i;
    }
    return -1;
  }

  wire::MapSender maps;
  wire::Map map = wire::sample_map(20, 6, 30);
  wire::MapReceiver receiver;
  std::uint32_t now_ms = 0;
  Frames taken;  ///< all that the application has been handed of maps
};

}  // namespace s4tp::secoc
