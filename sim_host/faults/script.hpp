#pragma once
/// A fault script: what goes wrong on the bus between world and ECU, and when. Plain data, made from a seed
/// or read from text, so that one that fails can be looked at, cut down and run again.
///
/// \code
///   seed 17
///   scenario left_turn
///   tick timer
///   fault loss from 120 for 40 messages Motion,Steering intensity 30 dice 912
/// \endcode
/// Ticks are 10 ms, counted from the instant the ECU takes over; the pre-roll is before 0.

#include <cstdint>
#include <string>
#include <vector>

namespace s4tp::faults {

inline constexpr int kPreRollTicks = 300;
inline constexpr int kRunTicks = 1400;  ///< after entry
inline constexpr int kForGood = 2000;   ///< a fault this long outlives the run

enum class FaultKind : std::uint8_t {
  kLoss,
  kDelay,
  kDuplicate,
  kReorder,
  kCorrupt,
  kBusOff,
  kBurst,
  kBabble,
  kEarlyMotion,
  kLateMotion,
  kClockJump,
  kDeadMap,
  kDeadPerception,
  kDeadVehicle,
  kStuck,
  kPattern,
  kLongList,
  kLatePlan,
  kLie,
};
inline constexpr int kFaultKinds = 19;

/// Bit i: message i of kMessages.
using MessageSet = std::uint32_t;

struct MessageName {
  const char* name;
  std::uint32_t id;
};
/// Those a fault can strike; the last one is the ECU's, all others the world's.
inline constexpr int kMessageCount = 18;
[[nodiscard]] const MessageName& message(int index);
/// \return index of the message with that CAN id, -1: none
[[nodiscard]] int find_message(std::uint32_t id);
[[nodiscard]] bool contains(MessageSet set, std::uint32_t id);

struct KindTraits {
  const char* name;
  MessageSet messages;  ///< that it may strike
  int intensity_min;
  int intensity_max;
  bool lies;            ///< some sender says something false under a valid CRC
  const char* meaning;  ///< of the intensity
};
[[nodiscard]] const KindTraits& traits(FaultKind kind);

struct Fault {
  FaultKind kind = FaultKind::kLoss;
  int from_tick = 0;
  int ticks = 1;
  MessageSet messages = 0;
  int intensity = 0;
  std::uint32_t dice = 0;  ///< its random choices; they do not depend on the other faults, nor on its length

  [[nodiscard]] int end_tick() const { return from_tick + ticks; }
  [[nodiscard]] bool active(int tick) const { return tick >= from_tick && tick < end_tick(); }
};

/// What opens a control tick of the ECU.
enum class TickSource : std::uint8_t {
  kTimer,     ///< every 10 ms, as in a car
  kLockstep,  ///< each TICK frame that reaches it, as in simulation
};

struct FaultScript {
  std::uint64_t seed = 0;  ///< the world's too
  std::string scenario;
  TickSource tick = TickSource::kTimer;
  std::vector<Fault> faults;
};

/// No sender in it says something false under a valid CRC.
[[nodiscard]] bool honest(const FaultScript& script);

/// FAULT-001 The same seed gives the same script, to the byte of its text.
[[nodiscard]] FaultScript make_script(std::uint64_t seed, const std::vector<std::string>& scenarios);

/// FAULT-002 parse_script(to_text(script)) is the script.
[[nodiscard]] std::string to_text(const FaultScript& script);
[[nodiscard]] std::string to_text(const Fault& fault);
/// \param source  named in messages, usually the file  \throws std::runtime_error naming source, line, what
/// is wrong and what is accepted
[[nodiscard]] FaultScript parse_script(const std::string& text, const std::string& source);

}  // namespace s4tp::faults
