#pragma once
/// The key that two ends of a bus share for as long as both run, and what makes a companion frame fresh.
/// Modelled on AUTOSAR SecOC (truncated MAC, truncated freshness value), not conforming to it.
///
/// AUTH-010 The session's key is the CMAC, under the long-term key, of the nonces of both ends: what was
/// recorded under other nonces verifies nowhere. Nonces travel in the clear.
///
/// \code
///   no session    says its nonce ten times a second, with a request        --nonce, request-->
///   has a session answers a request with a nonce never used before         <--nonce----------
///                 and keeps its session until a companion verifies under
///                 the key of both new nonces                               --companion------->
/// \endcode
/// AUTH-011 Either end may restart at any time: a nonce that an old session was made of is not used for a new
/// one, so the end that went on contributes a fresh one, too. AUTH-012 A lost nonce is said again. AUTH-013 A
/// nonce that somebody else says, replayed or invented, takes no session away: it leads to a candidate that
/// no companion verifies under, forgotten after kForgetTicks. AUTH-014 When nothing has verified for
/// kForgetTicks the session is over and a new one is asked for.

#include <cstdint>

#include "firmware/secoc/message.hpp"
#include "hal/authenticator.hpp"

namespace s4tp::secoc {

enum class End : std::uint8_t { kEcu, kWorld };

/// Payload of a companion frame.
struct Companion {
  std::uint64_t mac = 0;        ///< the first 48 bits of the CMAC
  std::uint16_t freshness = 0;  ///< the lowest 16 bits
};

struct Nonce {
  std::uint64_t value = 0;  ///< 52 bits
  bool request = false;     ///< its sender has no session
};

class Session {
 public:
  static constexpr int kForgetTicks = 100;  ///< own periods of 10 ms
  static constexpr int kSayTicks = 10;      ///< between two nonces of ours, whatever is asked for

  /// \param keys  must outlive this
  Session(hal::Authenticator& keys, End end) : keys_(keys), end_(end) {}

  /// A companion for a group that goes out, under the session's key, before there is a session under the
  /// candidate's. AUTH-002 Its freshness value has never been used under this key.
  /// \return false when there is no key at all
  [[nodiscard]] bool seal(Message& message, Companion& companion);
  /// AUTH-001 Whether a group that came in is genuine and fresh. AUTH-003 A forged companion passes with a
  /// probability of 2^-48 (2^-47 while a candidate is open). AUTH-004 Fresh is a value above the last one of
  /// its group: of the 64-bit counter 16 bits travel, and the receiver takes the next value that ends in
  /// them, 65,536 further at most; the MAC is over all 64, so that one from 65,536 ago fits no more. Changes
  /// nothing when it answers false.
  [[nodiscard]] bool verify(Message& message, const Companion& companion);

  /// A nonce of the other end, or of somebody who says so.
  void hear(const Nonce& nonce);
  /// Once in each of this end's periods of 10 ms. \return whether a nonce is to be sent
  [[nodiscard]] bool tick(Nonce& nonce);
  /// Before there are periods. \return false when there is a session, or no nonce can be drawn
  [[nodiscard]] bool ask(Nonce& nonce);

  [[nodiscard]] bool live() const { return current_.valid; }
  /// Whether companions can be sent.
  [[nodiscard]] bool has_key() const { return current_.valid || candidate_.valid; }
  [[nodiscard]] std::uint32_t sessions() const { return sessions_; }  ///< so far

 private:
  struct Key {
    bool valid = false;
    std::uint64_t own = 0;  ///< nonces
    std::uint64_t peer = 0;
    std::uint64_t sent = 0;            ///< newest freshness value; counts on as long as `own` does
    std::uint64_t last[kGroups] = {};  ///< newest ones verified
  };

  [[nodiscard]] bool verifies(Key& key, hal::KeySlot slot, Message& message, const Companion& companion);
  [[nodiscard]] bool mac_of(hal::KeySlot slot, const Message& message, std::uint64_t& mac);
  [[nodiscard]] bool derive(hal::KeySlot slot, const Key& key);
  void take_candidate(std::uint64_t peer);
  void drop_candidate();
  [[nodiscard]] bool draw_if_spent();

  hal::Authenticator& keys_;
  End end_;
  Key current_;
  Key candidate_;          ///< its `own` and `sent` hold without it being valid, too
  bool own_spent_ = true;  ///< candidate_.own must not be used for another key
  bool answer_due_ = false;
  std::uint64_t answer_ = 0;
  int candidate_ticks_ = 0;
  int silent_ticks_ = 0;         ///< since something verified
  int quiet_ticks_ = kSayTicks;  ///< since a nonce of ours
  std::uint32_t sessions_ = 0;
};

}  // namespace s4tp::secoc
