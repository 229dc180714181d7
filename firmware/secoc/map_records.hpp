#pragma once
/// The map as it stands on the bus, frame by frame: what its companion is a MAC over. A record is a lane (its
/// slot) or a conflict (wire::kMaxLanes + its slot); its tag, the first 64 bits of the CMAC of its frames
/// under the long-term key, is made when the record has changed and kept.

#include <cstdint>

#include "firmware/secoc/message.hpp"
#include "firmware/wire/frame.hpp"
#include "firmware/wire/lane_map.hpp"
#include "firmware/wire/map_record.hpp"
#include "hal/authenticator.hpp"

namespace s4tp::secoc {

/// The header and its two slot frames: which records make the map.
class MapHead {
 public:
  static constexpr int kFrames = 3;

  /// \return whether it is a frame of the head; damaged ones are, but change nothing
  bool take(const wire::Frame& frame);
  [[nodiscard]] bool whole() const { return seen_ == 7U; }
  [[nodiscard]] bool in_use(int record) const;
  [[nodiscard]] std::uint16_t digest() const { return digest_; }
  [[nodiscard]] const wire::Frame& frame(int i) const { return frames_[i]; }
  /// The header before. A receiver of the map trusts only the second header that it sees: where the one
  /// before says the same under the counter before, it is bit for bit what the sender of this one says before
  /// it, whoever said it, and the two may be shown together.
  [[nodiscard]] const wire::Frame& before() const { return before_; }
  [[nodiscard]] bool said_before() const;

 private:
  wire::Frame before_;
  wire::Frame frames_[kFrames];  ///< MapHeader, lower and upper MapSlots
  std::uint32_t seen_ = 0;       ///< bit i: frames_[i]
  wire::LaneSet lanes_ = {};
  int conflict_count_ = 0;
  std::uint16_t digest_ = 0;
};

/// Where a record's frame belongs.
struct RecordPlace {
  int record = 0;
  int part = 0;
  int parts = 0;  ///< that the record has, as a lane's header says; 0: the frame does not say
  std::uint8_t revision = 0;
};
/// \return false: no frame of a record, or one that the wire does not allow
[[nodiscard]] bool find_place(const wire::Frame& frame, RecordPlace& place);

class MapRecords {
 public:
  /// A frame of another revision begins its record anew. \return whether the record is another one now
  [[nodiscard]] bool take(const wire::Frame& frame, const RecordPlace& place);
  /// Whether exactly this frame is there.
  [[nodiscard]] bool has(const wire::Frame& frame, const RecordPlace& place) const;
  [[nodiscard]] bool same(int record, const MapRecords& other) const;
  void copy(int record, const MapRecords& from);
  /// Frames of a complete record, in their order.
  [[nodiscard]] int parts(int record) const { return states_[record].parts; }
  [[nodiscard]] wire::Frame frame(int record, int part) const;

  /// Whether all records that the head names are there, with contents that fit its digest.
  [[nodiscard]] bool whole(const MapHead& head);
  /// Head and tags. \pre whole(head) \return false: the keeper of the keys failed
  [[nodiscard]] bool add_to(Message& message, const MapHead& head, hal::Authenticator& keys);

 private:
  struct State {
    std::uint8_t revision = 0xFF;
    std::uint8_t parts = 0;   ///< 0: not known
    std::uint16_t there = 0;  ///< bit i: part i arrived
    bool checked = false;     ///< `check` is that of the parts
    std::uint16_t check = 0;  ///< their sum (crc16.hpp)
    bool tagged = false;
    std::uint8_t tag[kTagBytes] = {};
  };
  [[nodiscard]] std::uint8_t (&at(int record, int part))[8];
  [[nodiscard]] const std::uint8_t (&at(int record, int part) const)[8];
  [[nodiscard]] bool complete(int record) const;
  [[nodiscard]] std::uint16_t check(int record);
  [[nodiscard]] bool make_tag(int record, hal::Authenticator& keys);

  State states_[kRecords];
  std::uint8_t lanes_[wire::kMaxLanes][wire::kMaxLaneParts][8] = {};
  std::uint8_t conflicts_[wire::kMaxConflicts][wire::kConflictParts][8] = {};
};

}  // namespace s4tp::secoc
