#include "firmware/secoc/session.hpp"

namespace s4tp::secoc {
namespace {

constexpr std::uint64_t kNonceMask = (std::uint64_t{1} << 52U) - 1U;
constexpr std::uint64_t kMacMask = (std::uint64_t{1} << 48U) - 1U;
constexpr std::uint64_t kWindow = 0x10000;
constexpr std::uint8_t kLabel[] = {'s', '4', 't', 'p', ' ', 's', 'e', 's', 's', 'i', 'o', 'n'};

int index_of(Group group) {
  return static_cast<int>(group) - 1;
}

/// The next value above `last` that ends in `low`.
std::uint64_t extend(std::uint64_t last, std::uint16_t low) {
  const std::uint64_t value = (last & ~(kWindow - 1U)) | low;
  return value > last ? value : value + kWindow;
}

}  // namespace

bool Session::mac_of(hal::KeySlot slot, const Message& message, std::uint64_t& mac) {
  std::uint8_t bytes[hal::kCmacBytes] = {};
  if (!keys_.cmac(slot, message.bytes(), message.size(), bytes)) return false;
  mac = 0;
  for (unsigned i = 0; i < 6; ++i) mac |= static_cast<std::uint64_t>(bytes[i]) << (8U * i);
  return true;
}

bool Session::derive(hal::KeySlot slot, const Key& key) {
  std::uint8_t bytes[sizeof kLabel + 16] = {};
  for (unsigned i = 0; i < sizeof kLabel; ++i) bytes[i] = kLabel[i];
  const std::uint64_t ecu = end_ == End::kEcu ? key.own : key.peer;
  const std::uint64_t world = end_ == End::kEcu ? key.peer : key.own;
  for (unsigned i = 0; i < 8; ++i) {
    bytes[sizeof kLabel + i] = static_cast<std::uint8_t>(ecu >> (8U * i));
    bytes[sizeof kLabel + 8 + i] = static_cast<std::uint8_t>(world >> (8U * i));
  }
  return keys_.derive(slot, bytes, sizeof bytes);
}

bool Session::seal(Message& message, Companion& companion) {
  if (!has_key()) return false;
  Key& key = current_.valid ? current_ : candidate_;
  const std::uint64_t freshness = key.sent + 1U;
  message.set_freshness(freshness);
  const hal::KeySlot slot = current_.valid ? hal::KeySlot::kSession : hal::KeySlot::kCandidate;
  if (!mac_of(slot, message, companion.mac)) return false;
  key.sent = freshness;
  companion.freshness = static_cast<std::uint16_t>(freshness & (kWindow - 1U));
  return true;
}

bool Session::verifies(Key& key, hal::KeySlot slot, Message& message, const Companion& companion) {
  if (!key.valid) return false;
  std::uint64_t& last = key.last[index_of(message.group())];
  const std::uint64_t freshness = extend(last, companion.freshness);
  message.set_freshness(freshness);
  std::uint64_t mac = 0;
  if (!mac_of(slot, message, mac) || ((mac ^ companion.mac) & kMacMask) != 0U) return false;
  last = freshness;
  return true;
}

bool Session::verify(Message& message, const Companion& companion) {
  bool genuine = verifies(current_, hal::KeySlot::kSession, message, companion);
  if (!genuine && verifies(candidate_, hal::KeySlot::kCandidate, message, companion)) {
    current_ = candidate_;
    current_.valid = genuine = derive(hal::KeySlot::kSession, candidate_);
    drop_candidate();
    ++sessions_;
  }
  if (genuine) silent_ticks_ = 0;
  return genuine;
}

void Session::hear(const Nonce& nonce) {
  const std::uint64_t peer = nonce.value & kNonceMask;
  if (current_.valid && peer == current_.peer) {  // it has not heard, or has lost, ours
    answer_due_ = answer_due_ || nonce.request;
    answer_ = current_.own;
    return;
  }
  if (current_.valid && !nonce.request) return;
  if (candidate_.valid && peer == candidate_.peer) {
    candidate_ticks_ = 0;
  } else {
    take_candidate(peer);
  }
  answer_due_ = answer_due_ || (nonce.request && candidate_.valid);
  answer_ = candidate_.own;
}

void Session::take_candidate(std::uint64_t peer) {
  candidate_.valid = false;
  if (!draw_if_spent()) return;
  candidate_.peer = peer;
  for (std::uint64_t& last : candidate_.last) last = 0;
  candidate_ticks_ = 0;
  candidate_.valid = derive(hal::KeySlot::kCandidate, candidate_);
}

void Session::drop_candidate() {
  candidate_.valid = false;
  own_spent_ = true;
}

bool Session::draw_if_spent() {
  if (!own_spent_) return true;
  std::uint8_t bytes[8] = {};
  if (!keys_.random(bytes, sizeof bytes)) return false;
  candidate_.own = 0;
  for (unsigned i = 0; i < 8; ++i) candidate_.own |= static_cast<std::uint64_t>(bytes[i]) << (8U * i);
  candidate_.own &= kNonceMask;
  candidate_.sent = 0;
  own_spent_ = false;
  return true;
}

bool Session::tick(Nonce& nonce) {
  if (candidate_.valid && ++candidate_ticks_ > kForgetTicks) drop_candidate();
  if (current_.valid && ++silent_ticks_ > kForgetTicks) current_.valid = false;
  if (quiet_ticks_ < kSayTicks) ++quiet_ticks_;
  if (quiet_ticks_ < kSayTicks) return false;
  if (ask(nonce)) return true;
  if (!current_.valid || !answer_due_) return false;
  nonce = {answer_, false};
  answer_due_ = false;
  quiet_ticks_ = 0;
  return true;
}

bool Session::ask(Nonce& nonce) {
  if (current_.valid || !draw_if_spent()) return false;
  nonce = {candidate_.own, true};
  answer_due_ = false;
  quiet_ticks_ = 0;
  return true;
}

}  // namespace s4tp::secoc
