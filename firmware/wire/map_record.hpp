#pragma once
/// A lane or a conflict as frames: what sender and receiver of the map share. The parts of a lane are its
/// header, route, links, then its points; those of a conflict its first and its second lane.

#include <cstdint>

#include "firmware/wire/crc16.hpp"
#include "firmware/wire/frame.hpp"
#include "firmware/wire/lane_map.hpp"

namespace s4tp::wire {

inline constexpr int kLaneHeaderPart = 0;
inline constexpr int kLaneRoutePart = 1;
inline constexpr int kLaneLinksPart = 2;
inline constexpr int kFirstPointPart = 3;
inline constexpr std::uint8_t kRevisions = 16;

/// Lane slots in use, 32 a word.
using LaneSet = std::uint32_t[2];
[[nodiscard]] bool contains(const LaneSet& lanes, int lane);

/// What a half of the slots says of the revisions of its records in use, taken lanes first, by slot.
class RevisionDigest {
 public:
  static constexpr int kLanes = kMaxLanes / 2;  ///< of each half
  static constexpr int kConflicts = kMaxConflicts / 2;

  void add(std::uint8_t revision) { crc_ = crc16_add(crc_, revision); }
  /// The lower 15 bits of the CRC-16 of one byte a record: what there is room for.
  [[nodiscard]] std::uint16_t value() const { return static_cast<std::uint16_t>(crc_ & 0x7FFFU); }

 private:
  std::uint16_t crc_ = kCrc16Start;
};

[[nodiscard]] int part_count(const Lane& lane);
[[nodiscard]] int part_count(const Conflict& conflict);

/// Sealed frame of a part. \return false when a value does not fit the wire
[[nodiscard]] bool encode_part(const Lane& lane, int slot, std::uint8_t revision, int part, Frame& frame);
[[nodiscard]] bool encode_part(const Conflict& conflict, int slot, std::uint8_t revision, int part,
                               Frame& frame);

/// Whether a present lane's links name only lanes that exist, or none.
[[nodiscard]] bool links_exist(const Lane& lane, const LaneSet& lanes);
/// Whether a present conflict is one of two lanes that exist, entered before they are left.
[[nodiscard]] bool conflict_holds(const Conflict& conflict, const LaneSet& lanes);

}  // namespace s4tp::wire
