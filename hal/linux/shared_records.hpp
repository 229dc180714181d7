#pragma once
/// Plain records in shared memory, from one process that must never wait to any number that may.
///
/// \code
///   stream, state     [ 7 ][ 8 ][ 6 ]        three slots: the writer fills the oldest, readers take the
///   newest stream, events    [12][13][14][15][ 8 ].. many slots: readers take each in turn and count what
///   they missed
/// \endcode
/// Each slot carries the number of its record, 0 while it is being written. A reader copies a slot and looks
/// at the number again: what changed meanwhile is not taken. Readers map the memory for reading only, so no
/// reader, stopped, mad or killed, can reach the writer.

#include <atomic>
#include <cstdint>

#include "hal/linux/linux_can.hpp"

namespace s4tp::hal::linux_host {

inline constexpr std::uint32_t kSharedLayoutVersion = 1;
inline constexpr int kMaxSharedStreams = 16;
inline constexpr std::uint32_t kStateSlots = 3;

struct StreamSpec {
  std::uint32_t record_bytes = 0;  ///< of each record
  std::uint32_t slots = 0;         ///< kStateSlots where only the newest counts
};

/// What both ends must agree on: the streams, and what their records hold.
struct SharedLayout {
  const StreamSpec* streams = nullptr;
  int stream_count = 0;
  std::uint32_t fingerprint = 0;  ///< of the records' fields; changes whenever one of them does
};

struct SharedHead;

class SharedRecordsWriter {
 public:
  SharedRecordsWriter() = default;
  ~SharedRecordsWriter() { close(); }
  SharedRecordsWriter(const SharedRecordsWriter&) = delete;
  SharedRecordsWriter& operator=(const SharedRecordsWriter&) = delete;

  /// SHM-001 Takes the place of memory of that name a writer before left behind; who still reads that finds
  /// it abandoned. Only this user may read it. \param name  "/s4tp_ecu"; the memory shows as a file of
  /// /dev/shm \return false, with the reason
  [[nodiscard]] bool create(const char* name, const SharedLayout& layout, Reason& reason);
  /// SHM-002 No lock, no system call, no wait: a bounded copy. One thread a stream. Nothing before create().
  void write(int stream, const void* record);
  /// Readers are told that nothing more will come; the name goes, if it is still ours.
  void close();
  [[nodiscard]] bool is_open() const { return head_ != nullptr; }

 private:
  SharedHead* head_ = nullptr;
  std::uint64_t bytes_ = 0;
  char name_[64] = {};
  std::uint64_t inode_ = 0;
};

class SharedRecordsReader {
 public:
  SharedRecordsReader() = default;
  ~SharedRecordsReader() { close(); }
  SharedRecordsReader(const SharedRecordsReader&) = delete;
  SharedRecordsReader& operator=(const SharedRecordsReader&) = delete;

  /// SHM-003 Memory of another layout version, other streams or another fingerprint is refused, and so is
  /// what is too short for what it says. \return false, with the reason
  [[nodiscard]] bool open(const char* name, const SharedLayout& layout, Reason& reason);
  void close();
  [[nodiscard]] bool is_open() const { return head_ != nullptr; }

  /// Number of the newest record; 0: none yet. \pre is_open()
  [[nodiscard]] std::uint64_t newest(int stream) const;
  /// SHM-004 A record comes whole or not at all. \return false when `number` is overwritten or not there yet
  [[nodiscard]] bool read(int stream, std::uint64_t number, void* record) const;
  /// SHM-005 The next event after number `cursor`, which is moved on; `lost` grows by those that were
  /// overwritten before they were read. \return false when there is no newer one
  [[nodiscard]] bool next(int stream, std::uint64_t& cursor, std::uint64_t& lost, void* record) const;
  /// Whether the writer has closed it, died, or another one has taken the name.
  [[nodiscard]] bool abandoned() const;
  /// The writer's process; 0 when closed.
  [[nodiscard]] int writer() const;

 private:
  const SharedHead* head_ = nullptr;
  std::uint64_t bytes_ = 0;
  char name_[64] = {};
  std::uint64_t inode_ = 0;
};

}  // namespace s4tp::hal::linux_host
