#pragma once
/// A bus that loses, repeats, delays, damages and truncates frames, as far as CRC-8 can see it: up to two
/// bits, or a burst of eight.

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include "firmware/wire/frame.hpp"

namespace s4tp::wire {

/// Chance of each in 256.
struct Faults {
  int lost = 0;
  int repeated = 0;
  int delayed = 0;
  int damaged = 0;
  int truncated = 0;
};

class BadBus {
 public:
  /// \param delay_max  in units of send()'s time
  BadBus(std::uint32_t seed, const Faults& faults, int delay_max)
      : random_(seed), faults_(faults), delay_max_(delay_max) {}

  void send(int time, const Frame& frame) {
    put(time, frame);
    if (happens(faults_.repeated)) put(time, frame);
  }

  /// Frames due up to `time`, in the order of their arrival.
  std::vector<Frame> receive(int time) {
    std::stable_sort(pending_.begin(), pending_.end(),
                     [](const Pending& a, const Pending& b) { return a.time < b.time; });
    std::vector<Frame> frames;
    while (!pending_.empty() && pending_.front().time <= time) {
      frames.push_back(pending_.front().frame);
      pending_.erase(pending_.begin());
    }
    return frames;
  }

 private:
  struct Pending {
    int time;
    Frame frame;
  };

  bool happens(int chance) { return static_cast<int>(random_() % 256U) < chance; }
  unsigned below(unsigned bound) { return static_cast<unsigned>(random_() % bound); }

  void put(int time, Frame frame) {
    if (happens(faults_.lost)) return;
    if (happens(faults_.damaged)) damage(frame);
    if (happens(faults_.truncated)) frame.length = static_cast<std::uint8_t>(below(8));
    if (happens(faults_.delayed)) time += 1 + static_cast<int>(below(static_cast<unsigned>(delay_max_)));
    pending_.push_back({time, frame});
  }

  void damage(Frame& frame) {
    const auto flip = [&](unsigned bit) {
      frame.data[bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8));
    };
    if (below(2) == 0) {
      const unsigned first = below(64);
      flip(first);
      if (below(2) == 0) flip((first + 1 + below(63)) % 64);
    } else {
      // As bits travel: the highest of a byte first.
      const unsigned start = below(57);
      const unsigned pattern = 1U + below(255);
      for (unsigned i = 0; i < 8; ++i) {
        if ((pattern >> i) & 1U) flip((start + i) / 8 * 8 + 7 - (start + i) % 8);
      }
    }
  }

  std::mt19937 random_;
  Faults faults_;
  int delay_max_;
  std::vector<Pending> pending_;
};

}  // namespace s4tp::wire
