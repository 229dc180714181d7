// The map receiver: frames of a map that was sent, with others among them; records that no sender of ours would send, under a
// digest that fits. Whatever comes out holds together, and undisturbed it is what was sent.

#include <algorithm>
#include <vector>

#include "firmware/wire/crc16.hpp"
#include "firmware/wire/lane_map.hpp"
#include "firmware/wire/map_record.hpp"
#include "tests/fuzz/frames.hpp"
#include "tests/support/wire_samples.hpp"

using namespace s4tp;
using fuzz::expect;
using fuzz::Input;

namespace {

constexpr int kSlots = 8;  // of lanes and conflicts the fuzzer touches; few, so that they meet

wire::Lane take_lane(Input& input) {
  wire::Lane lane;
  lane.present = input.below(8) != 7;
  lane.kind = static_cast<std::uint8_t>(input.below(3));
  lane.point_count = static_cast<std::uint8_t>(input.below(wire::kMaxLanePoints + 1));
  lane.on_route = input.below(2) != 0;
  lane.in_junction = input.below(2) != 0;
  lane.changes_needed = static_cast<std::int8_t>(input.below(16) - 8);
  lane.speed_limit_mps = input.real(0.0F, 63.0F);
  lane.width_m = input.real(0.0F, 6.4F);
  lane.stop_line_m = input.real(-1.0F, 10.0F);
  for (std::uint8_t& link : lane.successors)
    link = input.byte() % 4 == 0 ? input.byte() % (kSlots + 1) : wire::kNoLane;
  lane.left = input.byte() % 4 == 0 ? input.byte() % (kSlots + 1) : wire::kNoLane;
  for (int i = 0; i < lane.point_count; ++i) {
    lane.x_m[i] = input.real(-2000.0F, 2000.0F);
    lane.y_m[i] = input.below(64) == 63 ? input.take<float>() : static_cast<float>(i);
  }
  return lane;
}

wire::Conflict take_conflict(Input& input) {
  wire::Conflict conflict;
  conflict.present = input.below(8) != 7;
  conflict.first = static_cast<std::uint8_t>(input.below(kSlots));
  conflict.second = static_cast<std::uint8_t>(input.below(kSlots));
  conflict.priority = static_cast<std::uint8_t>(input.below(3));
  conflict.first_entry_m = static_cast<float>(input.byte());
  conflict.first_exit_m = static_cast<float>(input.byte());
  conflict.second_exit_m = static_cast<float>(input.byte());
  return conflict;
}

void check(const wire::Map& map) {
  wire::LaneSet lanes = {};
  for (int slot = 0; slot < wire::kMaxLanes; ++slot) {
    if (map.lanes[slot].present) lanes[slot / 32] |= 1U << (slot % 32);
  }
  for (const wire::Lane& lane : map.lanes) {
    expect(!lane.present || (wire::links_exist(lane, lanes) && lane.point_count >= 2),
           "a lane's links lead to lanes");
    expect(lane.point_count <= wire::kMaxLanePoints, "a lane has no more points than there is room for");
  }
  for (const wire::Conflict& conflict : map.conflicts) {
    expect(!conflict.present || wire::conflict_holds(conflict, lanes), "a conflict is one of two lanes");
  }
}

/// Records as the fuzzer wants them, whatever a sender of ours would say, under a header and a digest that fit.
class Forger {
 public:
  void change(Input& input, wire::MapReceiver& receiver) {
    const bool lane = input.below(3) != 2;
    const int slot = input.below(kSlots);
    revision_ = static_cast<std::uint8_t>((revision_ + 1) % wire::kRevisions);
    (lane ? lane_revisions_ : conflict_revisions_)[slot] = revision_;
    if (lane) {
      lanes_[slot] = take_lane(input);
      send(lanes_[slot], slot, lane_checks_[slot], receiver);
    } else {
      conflicts_[slot] = take_conflict(input);
      send(conflicts_[slot], slot, conflict_checks_[slot], receiver);
    }
  }

  void announce(Input& input, wire::MapReceiver& receiver) {
    wire::MapHeader header;
    header.generation = ++generation_;
    header.conflict_count = static_cast<std::uint8_t>(input.below(kSlots + 1));
    std::uint32_t in_use = input.byte();
    unsigned digest = 0;
    wire::RevisionDigest revisions[2];
    for (int slot = 0; slot < kSlots; ++slot) {
      if (lane_checks_[slot] == 0) in_use &= ~(1U << slot);
      if ((in_use >> slot & 1U) == 0) continue;
      digest += lane_checks_[slot];
      revisions[0].add(lane_revisions_[slot]);
      ++header.lane_count;
    }
    for (int slot = 0; slot < header.conflict_count; ++slot) {
      digest += conflict_checks_[slot];
      revisions[0].add(conflict_revisions_[slot]);
    }
    header.digest = static_cast<std::uint16_t>(digest);
    wire::Frame frame;
    expect(wire::encode(header, frame), "a header fits the wire");
    protection_.protect(frame);
    static_cast<void>(receiver.accept(frame));
    for (std::uint8_t half = 0; half < 2; ++half) {
      const wire::MapSlots slots{.generation = generation_,
                                 .half = half,
                                 .in_use = half == 0 ? in_use : 0,
                                 .revisions = revisions[half].value()};
      expect(wire::encode(slots, frame), "slots fit the wire");
      wire::e2e_seal(frame);
      if (receiver.accept(frame)) check(receiver.map());
    }
  }

 private:
  template <class Record>
  void send(const Record& record, int slot, std::uint16_t& check_sum, wire::MapReceiver& receiver) const {
    unsigned sum = 0;
    for (int part = 0; part < wire::part_count(record); ++part) {
      wire::Frame frame;
      if (!wire::encode_part(record, slot, revision_, part, frame)) return;
      sum += wire::frame_check(frame);
      if (receiver.accept(frame)) check(receiver.map());
    }
    check_sum = static_cast<std::uint16_t>(sum);
  }

  wire::Lane lanes_[kSlots];
  wire::Conflict conflicts_[kSlots];
  std::uint16_t lane_checks_[kSlots] = {};
  std::uint16_t conflict_checks_[kSlots] = {};
  std::uint8_t lane_revisions_[kSlots] = {};
  std::uint8_t conflict_revisions_[kSlots] = {};
  wire::E2eSender protection_;
  std::uint8_t generation_ = 0;
  std::uint8_t revision_ = 0;
};

/// What a good bus delivers of a map.
wire::Map delivered(const wire::Map& map) {
  wire::MapSender sender;
  wire::MapReceiver receiver;
  sender.update(map);
  for (std::uint32_t now_ms = 0; now_ms < 200; now_ms += 100) {
    for (const wire::Frame& frame : wire::frames_of(sender, now_ms, 2000))
      static_cast<void>(receiver.accept(frame));
  }
  return receiver.map();
}

/// A sender of ours; its frames are lost, repeated or overtake each other.
void drive(Input& input) {
  wire::MapSender sender;
  wire::MapReceiver receiver;
  wire::Map map;
  std::vector<wire::Map> sent;
  std::uint32_t now_ms = input.take<std::uint32_t>();
  for (int round = 0; round < 8 && !input.empty(); ++round) {
    for (int changes = 1 + input.below(4); changes > 0; --changes) {
      if (input.below(3) != 2) {
        map.lanes[input.below(kSlots)] = take_lane(input);
      } else {
        map.conflicts[input.below(kSlots)] = take_conflict(input);
      }
    }
    sender.update(map);
    sent.push_back(delivered(map));
    for (int ticks = 1 + input.below(12); ticks > 0;
         --ticks, now_ms += 10U * static_cast<unsigned>(1 + input.below(12))) {
      std::vector<wire::Frame> frames = wire::frames_of(sender, now_ms, 1 + input.below(40));
      if (input.below(4) == 0 && !frames.empty())
        frames.erase(frames.begin() + input.below(static_cast<int>(frames.size())));
      if (input.below(4) == 0) std::reverse(frames.begin(), frames.end());
      for (const wire::Frame& frame : frames) {
        if (!receiver.accept(frame)) continue;
        check(receiver.map());
        expect(std::find(sent.rbegin(), sent.rend(), receiver.map()) != sent.rend(),
               "a map is one that was sent");
      }
      if (input.below(16) == 15) receiver.nothing_arrived();
    }
  }
}

void forge(Input& input) {
  wire::MapReceiver receiver;
  Forger forger;
  fuzz::Counters counters;
  forger.announce(input, receiver);
  while (!input.empty()) {
    switch (input.below(4)) {
      case 0:
      case 1:
        forger.change(input, receiver);
        break;
      case 2:
        forger.announce(input, receiver);
        break;
      default:
        if (receiver.accept(fuzz::take_frame(input, counters))) check(receiver.map());
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Input input(data, size);
  if (input.below(2) == 0) {
    drive(input);
  } else {
    forge(input);
  }
  return 0;
}
