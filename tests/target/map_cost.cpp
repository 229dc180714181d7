/// What a burst of the map costs the control context: prints instructions, and fails where they are too many.

#include "firmware/targets/text.hpp"
#include "firmware/wire/codec.hpp"
#include "firmware/wire/lane_map.hpp"
#include "hal/mps/board.hpp"
#include "hal/mps/semihosting.hpp"
#include "hal/mps/startup.hpp"
#include "hal/mps/timer.hpp"

using namespace s4tp;

namespace {

constexpr int kBurst = 37;          // frames in 10 ms on a bus of 500 kbit/s that carries nothing else
constexpr int kRecordFrames = 400;  // what changes later on: 13 lanes of 15 frames
constexpr std::uint32_t kLimit = 100'000;
constexpr std::uint32_t kInstructionHz = 15'625'000;  // -icount shift=6: one takes 64 ns

hal::mps::Timer timer;
wire::Map map;
wire::MapSender sender;
wire::MapReceiver receiver;
std::uint32_t now_ms = 0;

/// \param seed  every lane with one has other points
void make_lane(int slot, int seed) {
  wire::Lane& lane = map.lanes[slot];
  lane.present = true;
  lane.point_count = wire::kMaxLanePoints;
  lane.speed_limit_mps = 13.75F;
  lane.width_m = 3.2F;
  for (int i = 0; i < wire::kMaxLanePoints; ++i) {
    lane.x_m[i] = static_cast<float>(10 * i);
    lane.y_m[i] = static_cast<float>(3 * slot + seed);
  }
}

void make_map() {
  for (int slot = 0; slot < wire::kMaxLanes; ++slot) make_lane(slot, 0);
  for (int slot = 0; slot < wire::kMaxConflicts; ++slot) {
    wire::Conflict& conflict = map.conflicts[slot];
    conflict.present = true;
    conflict.first = static_cast<std::uint8_t>(slot % wire::kMaxLanes);
    conflict.second = static_cast<std::uint8_t>((slot + 1) % wire::kMaxLanes);
    conflict.first_exit_m = conflict.second_exit_m = static_cast<float>(slot);
  }
}

/// \return counts that the receiver takes for them
std::uint32_t show(const wire::Frame* burst, int size) {
  const std::uint32_t began = timer.now();
  for (int i = 0; i < size; ++i) (void)receiver.accept(burst[i]);
  return timer.now() - began;
}

/// Shows the receiver `frames` of the map. \return counts of the most expensive burst; the map is whole once
/// at most, and the copy that this takes is in it
std::uint32_t worst_burst(int frames) {
  std::uint32_t worst = 0;
  for (int sent = 0; sent < frames; sent += kBurst) {
    wire::Frame burst[kBurst];
    int size = 0;
    for (int tries = 0; size < kBurst && tries < 1000; ++tries) {
      if (sender.next(now_ms, burst[size])) {
        ++size;
      } else {
        now_ms += 10;
      }
    }
    const std::uint32_t counts = show(burst, size);
    if (counts > worst) worst = counts;
  }
  return worst;
}

/// A header and slots: all records in use, or none, and a digest that fits neither.
void make_heads(bool all, wire::E2eSender& protection, wire::Frame (&frames)[3]) {
  wire::MapHeader header;
  header.lane_count = all ? wire::kMaxLanes : 0;
  header.conflict_count = all ? wire::kMaxConflicts : 0;
  header.digest = 1;
  (void)wire::encode(header, frames[0]);
  protection.protect(frames[0]);
  for (int half = 0; half < 2; ++half) {
    wire::MapSlots slots;
    slots.half = static_cast<std::uint8_t>(half);
    slots.in_use = all ? UINT32_MAX : 0;
    (void)wire::encode(slots, frames[1 + half]);
    wire::e2e_seal(frames[1 + half]);
  }
}

/// Shows the receiver headers and slots that take all records out of use and into it again. \return counts of
/// the most expensive burst; the first headers are not trusted yet
std::uint32_t worst_burst_of_heads(int bursts) {
  wire::E2eSender protection;
  bool all = true;
  std::uint32_t worst = 0;
  for (int sent = 0; sent < bursts; ++sent) {
    wire::Frame burst[kBurst];
    wire::Frame heads[3];
    for (int i = 0; i < kBurst; ++i) {
      if (i % 3 == 0) {
        all = !all;
        make_heads(all, protection, heads);
      }
      burst[i] = heads[i % 3];
    }
    const std::uint32_t counts = show(burst, kBurst);
    if (counts > worst) worst = counts;
  }
  return worst;
}

std::uint32_t report(const char* what, std::uint32_t counts) {
  const auto instructions =
      static_cast<std::uint32_t>(std::uint64_t{counts} * kInstructionHz / hal::mps::kCoreClockHz);
  targets::Text line;
  line << what << ": " << instructions << " instructions for " << std::int32_t{kBurst} << " frames\n";
  hal::mps::semihosting::print(line.c_str());
  return instructions;
}

}  // namespace

void systick_handler() {
  timer.on_interrupt();
}

void image_main() {
  timer.start(500'000);
  make_map();
  sender.update(map);
  const std::uint32_t first = report("first map", worst_burst(1400));
  for (int slot = 0; slot < 13; ++slot) make_lane(slot, 1);
  sender.update(map);
  const std::uint32_t changed = report("changed map", worst_burst(kRecordFrames));
  const bool whole = receiver.confirmed();
  const std::uint32_t heads = report("headers and slots", worst_burst_of_heads(3));
  // The last header announced another map, and was heard.
  const bool good = whole && !receiver.confirmed() && first < kLimit && changed < kLimit && heads < kLimit;
  hal::mps::semihosting::print(good ? "within the limit\n" : "does not hold\n");
  hal::mps::semihosting::exit(good ? 0 : 1);
}
