#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "firmware/ecu/event_ring.hpp"
#include "firmware/ecu/triple_buffer.hpp"

namespace s4tp::ecu {
namespace {

/// Large enough that a torn copy would show: all words carry the same number.
struct Block {
  std::uint32_t words[64] = {};
};

void fill(Block& block, std::uint32_t number) {
  for (std::uint32_t& word : block.words) word = number;
}

bool is_whole(const Block& block) {
  for (const std::uint32_t word : block.words) {
    if (word != block.words[0]) return false;
  }
  return true;
}

// ECU-080: of 1, 2, 3 published in a row the reader sees 3, once, and keeps it.
TEST(TripleBuffer, NewestWins) {
  TripleBuffer<int> buffer;
  EXPECT_FALSE(buffer.refresh());
  for (const int value : {1, 2, 3}) {
    buffer.back() = value;
    buffer.publish();
  }
  EXPECT_TRUE(buffer.refresh());
  EXPECT_EQ(buffer.front(), 3);
  EXPECT_FALSE(buffer.refresh());
  EXPECT_EQ(buffer.front(), 3);
  // What the writer fills meanwhile is not seen before it is published.
  buffer.back() = 4;
  EXPECT_EQ(buffer.front(), 3);
}

// ECU-080: two threads, 200,000 values: the reader never sees a mixed one nor an older one than before, and
// in the end the last one.
TEST(TripleBuffer, HoldsUnderTwoThreads) {
  constexpr std::uint32_t kLast = 200000;
  TripleBuffer<Block> buffer;
  std::thread writer([&buffer] {
    for (std::uint32_t i = 1; i <= kLast; ++i) {
      fill(buffer.back(), i);
      buffer.publish();
    }
  });
  std::uint32_t newest = 0;
  bool whole = true;
  bool forward = true;
  while (newest != kLast) {
    if (!buffer.refresh()) {
      std::this_thread::yield();
      continue;
    }
    whole = whole && is_whole(buffer.front());
    forward = forward && buffer.front().words[0] > newest;
    newest = buffer.front().words[0];
  }
  writer.join();
  EXPECT_TRUE(whole);
  EXPECT_TRUE(forward);
}

// ECU-081: four places take 1 to 4, the fifth is dropped and counted; they come out in order.
TEST(EventRing, DropsTheNewWhenFull) {
  EventRing<int, 4> ring;
  EXPECT_TRUE(ring.drained());
  for (int value = 1; value <= 5; ++value) {
    int* slot = ring.claim();
    ASSERT_EQ(slot != nullptr, value <= 4);
    if (slot == nullptr) continue;
    *slot = value;
    ring.publish();
  }
  EXPECT_EQ(ring.dropped(), 1U);
  EXPECT_FALSE(ring.drained());
  for (int value = 1; value <= 4; ++value) {
    ASSERT_NE(ring.front(), nullptr);
    EXPECT_EQ(*ring.front(), value);
    ring.pop();
  }
  EXPECT_EQ(ring.front(), nullptr);
  EXPECT_TRUE(ring.drained());
}

// ECU-081: two threads through 8 places: every event that was not dropped arrives whole and in order.
TEST(EventRing, HoldsUnderTwoThreads) {
  constexpr std::uint32_t kEvents = 200000;
  EventRing<Block, 8> ring;
  std::atomic<bool> done{false};
  std::uint32_t sent = 0;
  std::thread writer([&ring, &done, &sent] {
    for (std::uint32_t i = 1; i <= kEvents; ++i) {
      Block* slot = ring.claim();
      if (slot == nullptr) {
        std::this_thread::yield();
        continue;
      }
      fill(*slot, i);
      ring.publish();
      ++sent;
    }
    done = true;
  });
  std::uint32_t received = 0;
  std::uint32_t last = 0;
  bool good = true;
  for (;;) {
    const bool finished = done;
    const Block* block = ring.front();
    if (block == nullptr) {
      if (finished) break;
      std::this_thread::yield();
      continue;
    }
    good = good && is_whole(*block) && block->words[0] > last;
    last = block->words[0];
    ++received;
    ring.pop();
  }
  writer.join();
  EXPECT_TRUE(good);
  EXPECT_EQ(received, sent);
  EXPECT_EQ(sent + ring.dropped(), kEvents);
}

}  // namespace
}  // namespace s4tp::ecu
