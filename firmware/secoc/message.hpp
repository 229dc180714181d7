#pragma once
/// What a companion frame authenticates, as one row of bytes:
///
/// \code
///   group (1) | freshness (8, lowest byte first) | per frame: id (2) data (8) | of the map, per record:
///   number (1) tag (8)
/// \endcode
/// The group's number keeps a MAC of one group from being one of another.

#include <cstdint>

#include "firmware/wire/frame.hpp"
#include "firmware/wire/lane_map.hpp"

namespace s4tp::secoc {

/// What is authenticated together. Its number is the first byte of what a MAC is over; 0 is that of tags.
enum class Group : std::uint8_t { kCommand = 1, kMotion = 2, kTracks = 3, kMap = 4 };
inline constexpr int kGroups = 4;

inline constexpr int kTagBytes = 8;
inline constexpr int kRecords = wire::kMaxLanes + wire::kMaxConflicts;

class Message {
 public:
  static constexpr int kHeadBytes = 9;
  static constexpr int kFrameBytes = 10;
  static constexpr int kMaxBytes = kHeadBytes + 3 * kFrameBytes + kRecords * (1 + kTagBytes);

  explicit Message(Group group) { bytes_[0] = static_cast<std::uint8_t>(group); }

  [[nodiscard]] Group group() const { return static_cast<Group>(bytes_[0]); }
  void set_freshness(std::uint64_t freshness) {
    for (int i = 0; i < 8; ++i) bytes_[1 + i] = static_cast<std::uint8_t>(freshness >> (8 * i));
  }
  void add(const wire::Frame& frame) {
    add_byte(static_cast<std::uint8_t>(frame.id & 0xFFU));
    add_byte(static_cast<std::uint8_t>(frame.id >> 8U));
    add(frame.data, 8);
  }
  void add(const std::uint8_t* bytes, int size) {
    for (int i = 0; i < size; ++i) add_byte(bytes[i]);
  }
  void add_byte(std::uint8_t byte) {
    if (size_ < kMaxBytes) bytes_[size_++] = byte;
  }
  [[nodiscard]] const std::uint8_t* bytes() const { return bytes_; }
  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(size_); }

 private:
  std::uint8_t bytes_[kMaxBytes] = {};
  int size_ = kHeadBytes;
};

}  // namespace s4tp::secoc
