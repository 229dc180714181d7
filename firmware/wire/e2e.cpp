#include "firmware/wire/e2e.hpp"

namespace s4tp::wire {
namespace {

constexpr std::uint8_t kPolynomial = 0x1D;
constexpr std::uint8_t kCounters = 15;  ///< 0 .. 14

struct CrcTable {
  std::uint8_t entries[256] = {};
};

constexpr CrcTable make_crc_table() {
  CrcTable table;
  for (unsigned value = 0; value < 256; ++value) {
    unsigned crc = value;
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 0x80U) != 0U ? (crc << 1U) ^ kPolynomial : crc << 1U;
    table.entries[value] = static_cast<std::uint8_t>(crc);
  }
  return table;
}

constexpr CrcTable kCrcTable = make_crc_table();

bool protectable(const Frame& frame) {
  return frame.length >= 2 && frame.length <= 8;
}

std::uint8_t counter_of(const Frame& frame) {
  return frame.data[1] & 0x0FU;
}

}  // namespace

std::uint8_t e2e_crc(const Frame& frame) {
  std::uint8_t crc = 0xFF;
  const auto add = [&crc](unsigned byte) { crc = kCrcTable.entries[crc ^ (byte & 0xFFU)]; };
  add(frame.id);
  add(frame.id >> 8U);
  for (int i = 1; i < frame.length && i < 8; ++i) add(frame.data[i]);
  return crc ^ 0xFFU;
}

bool e2e_crc_fits(const Frame& frame) {
  return protectable(frame) && frame.data[0] == e2e_crc(frame);
}

void e2e_seal(Frame& frame) {
  frame.data[0] = e2e_crc(frame);
}

void E2eSender::protect(Frame& frame) {
  frame.data[1] = static_cast<std::uint8_t>((frame.data[1] & 0xF0U) | counter_);
  counter_ = static_cast<std::uint8_t>((counter_ + 1) % kCounters);
  e2e_seal(frame);
}

E2eState E2eReceiver::check(const Frame& frame) {
  state_ = judge(frame);
  return state_;
}

E2eState E2eReceiver::nothing_arrived() {
  lose_one();
  state_ = E2eState::kNoNewData;
  return state_;
}

void E2eReceiver::lose_one() {
  if (lost_ < kCounters) ++lost_;
}

E2eState E2eReceiver::judge(const Frame& frame) {
  if (!e2e_crc_fits(frame) || counter_of(frame) >= kCounters) {
    lose_one();
    return E2eState::kWrongCrc;
  }
  const std::uint8_t counter = counter_of(frame);
  const int delta = (counter + kCounters - last_counter_) % kCounters;
  if (seen_ && delta == 0) {
    lose_one();
    return E2eState::kRepeated;
  }
  const bool silent_too_long = lost_ > kE2eMaxLost;
  const bool plausible = delta <= kE2eMaxDelta + lost_;
  last_counter_ = counter;
  lost_ = 0;
  if (!seen_) {
    seen_ = true;
    return E2eState::kInitial;
  }
  if (!plausible) {
    to_sync_ = kE2eSyncFrames;
    return E2eState::kWrongSequence;
  }
  if (silent_too_long) to_sync_ = kE2eSyncFrames;
  if (to_sync_ > 0) {
    --to_sync_;
    return E2eState::kSync;
  }
  return delta == 1 ? E2eState::kOk : E2eState::kOkSomeLost;
}

}  // namespace s4tp::wire
