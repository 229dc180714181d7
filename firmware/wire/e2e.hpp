#pragma once
/// End-to-end protection, modelled on AUTOSAR E2E profile 1: CRC-8 (polynomial 0x1D) over data id and payload
/// in byte 0, counter 0 .. 14 in the low nibble of byte 1. The data id is the CAN id.
///
/// Receiver, one per message. WIRE-010 .. WIRE-017, one id a state:
///   NONEWDATA  nothing arrived since the last look        INITIAL    first valid frame
///   WRONGCRC   a frame arrived damaged                    REPEATED   counter as before
///   SYNC       counter plausible again, not yet trusted   OK         counter one further
///   OKSOMELOST counter 2 .. kE2eMaxDelta further          WRONGSEQUENCE  counter jumped
///
///   WRONGSEQUENCE and more than kE2eMaxLost periods without a new frame cost the trust: the next
///   kE2eSyncFrames plausible frames are SYNC. A period without one widens the step allowed by 1.

#include <cstdint>

#include "firmware/wire/frame.hpp"

namespace s4tp::wire {

enum class E2eState : std::uint8_t {
  kOk = 0,             ///< WIRE-010 trusted
  kNoNewData = 1,      ///< WIRE-011 nothing new
  kWrongCrc = 2,       ///< WIRE-012 dropped
  kSync = 3,           ///< WIRE-013 dropped, counting towards trust
  kInitial = 4,        ///< WIRE-014 first one seen, dropped
  kRepeated = 5,       ///< WIRE-015 dropped
  kOkSomeLost = 6,     ///< WIRE-016 trusted
  kWrongSequence = 7,  ///< WIRE-017 dropped; resynchronises
};

inline constexpr std::uint8_t kE2eMaxDelta = 3;    ///< largest counter step that is still trusted
inline constexpr std::uint8_t kE2eMaxLost = 10;    ///< periods without a new frame before trust is lost
inline constexpr std::uint8_t kE2eSyncFrames = 2;  ///< valid frames before trust returns

/// CRC-8 (0x1D, initial 0xFF, final XOR 0xFF) over data id (low byte, high byte) and bytes 1 .. length - 1.
[[nodiscard]] std::uint8_t e2e_crc(const Frame& frame);
/// WIRE-001 A frame whose CRC fits, whatever its counter: list members, whose order their generation guards.
[[nodiscard]] bool e2e_crc_fits(const Frame& frame);
/// Writes the CRC of a frame whose other bytes are complete.
void e2e_seal(Frame& frame);

/// Sender side: counter and CRC of one message.
class E2eSender {
 public:
  void protect(Frame& frame);

 private:
  std::uint8_t counter_ = 0;
};

/// Receiver side of one message.
class E2eReceiver {
 public:
  /// Judges a frame that arrived. \return the new state; the frame's values may be used only if
  /// trusted(state)
  [[nodiscard]] E2eState check(const Frame& frame);
  /// To be called when a period ended without a frame. \return kNoNewData
  E2eState nothing_arrived();
  [[nodiscard]] E2eState state() const { return state_; }
  [[nodiscard]] static bool trusted(E2eState state) {
    return state == E2eState::kOk || state == E2eState::kOkSomeLost;
  }

 private:
  [[nodiscard]] E2eState judge(const Frame& frame);
  void lose_one();

  E2eState state_ = E2eState::kNoNewData;
  bool seen_ = false;
  std::uint8_t last_counter_ = 0;
  std::uint8_t lost_ = 0;     ///< looks without a new intact frame: each widens the delta allowed
  std::uint8_t to_sync_ = 0;  ///< valid frames still needed before trust returns
};

}  // namespace s4tp::wire
