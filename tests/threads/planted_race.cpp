// Does the thread sanitizer see what it is there for? `planted_race sound` hands values over through the
// TripleBuffer, `planted_race broken` through one whose exchange is no atomic operation.

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <thread>
#include <utility>

#include "firmware/ecu/triple_buffer.hpp"

namespace {

/// As TripleBuffer, with the mistake that would matter.
template <typename T>
class BrokenBuffer {
 public:
  T& back() { return slots_[back_]; }
  void publish() { back_ = std::exchange(middle_, back_ | kFresh) & kIndex; }
  bool refresh() {
    if ((middle_ & kFresh) == 0) return false;
    front_ = std::exchange(middle_, front_) & kIndex;
    return true;
  }
  const T& front() const { return slots_[front_]; }

 private:
  static constexpr int kIndex = 3;
  static constexpr int kFresh = 4;
  T slots_[3] = {};
  int back_ = 0;
  int front_ = 1;
  int middle_ = 2;
};

template <class Buffer>
std::uint64_t hand_over() {
  Buffer buffer;
  std::thread writer([&buffer] {
    for (std::uint32_t i = 1; i <= 10'000; ++i) {
      buffer.back() = i;
      buffer.publish();
    }
  });
  std::uint64_t sum = 0;
  for (int i = 0; i < 10'000; ++i) {
    if (buffer.refresh()) sum += buffer.front();
    if (i % 100 == 0) std::this_thread::yield();
  }
  writer.join();
  return sum;
}

}  // namespace

int main(int argc, char** argv) {
  const bool broken = argc > 1 && std::strcmp(argv[1], "broken") == 0;
  const std::uint64_t sum =
      broken ? hand_over<BrokenBuffer<std::uint32_t>>() : hand_over<s4tp::ecu::TripleBuffer<std::uint32_t>>();
  std::printf("sum %llu\n", static_cast<unsigned long long>(sum));
  return 0;
}
