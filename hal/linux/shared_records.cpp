#include "hal/linux/shared_records.hpp"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <new>

namespace s4tp::hal::linux_host {

/// What the memory begins with. `magic` is written last: before that nobody takes it for whole.
struct SharedHead {
  struct Stream {
    StreamSpec spec;
    std::uint64_t offset = 0;  ///< of the first slot, from the head
    std::atomic<std::uint64_t> written{0};
  };
  std::atomic<std::uint64_t> magic{0};
  std::uint32_t layout_version = kSharedLayoutVersion;
  std::uint32_t fingerprint = 0;
  std::uint64_t bytes = 0;
  std::uint32_t stream_count = 0;
  std::atomic<std::int32_t> writer{0};
  Stream streams[kMaxSharedStreams];
};

namespace {

using Word = std::atomic<std::uint64_t>;
static_assert(Word::is_always_lock_free, "a lock in the memory could be held by a reader");

constexpr std::uint64_t kMagic = 0x3150'4554'5034'5453U;
constexpr std::uint64_t kWordBytes = sizeof(std::uint64_t);
constexpr std::uint64_t kMaxRecordBytes = 1U << 20;
constexpr std::uint32_t kMaxSlots = 1U << 16;

std::uint64_t words_of(std::uint32_t bytes) {
  return (bytes + kWordBytes - 1) / kWordBytes;
}

/// A slot is the number of its record, then the record in whole words.
std::uint64_t slot_bytes(const StreamSpec& spec) {
  return kWordBytes * (1 + words_of(spec.record_bytes));
}

Word* slot_at(SharedHead* head, const SharedHead::Stream& stream, std::uint64_t number) {
  char* const base = reinterpret_cast<char*>(head) + stream.offset;
  return reinterpret_cast<Word*>(base + number % stream.spec.slots * slot_bytes(stream.spec));
}

const Word* slot_at(const SharedHead* head, const SharedHead::Stream& stream, std::uint64_t number) {
  const char* const base = reinterpret_cast<const char*>(head) + stream.offset;
  return reinterpret_cast<const Word*>(base + number % stream.spec.slots * slot_bytes(stream.spec));
}

std::uint64_t total_bytes(const SharedLayout& layout) {
  std::uint64_t bytes = sizeof(SharedHead);
  for (int i = 0; i < layout.stream_count; ++i)
    bytes += layout.streams[i].slots * slot_bytes(layout.streams[i]);
  return bytes;
}

bool sound(const SharedLayout& layout) {
  if (layout.stream_count < 1 || layout.stream_count > kMaxSharedStreams) return false;
  for (int i = 0; i < layout.stream_count; ++i) {
    const StreamSpec& spec = layout.streams[i];
    if (spec.record_bytes == 0 || spec.record_bytes > kMaxRecordBytes || spec.slots < kStateSlots ||
        spec.slots > kMaxSlots)
      return false;
  }
  return true;
}

bool refuse(Reason& reason, const char* name, const char* why) {
  snprintf(reason.text, sizeof reason.text, "shared memory %s: %s", name, why);
  return false;
}

bool keep_name(const char* name, char (&kept)[64]) {
  if (strlen(name) >= sizeof kept) return false;
  memcpy(kept, name, strlen(name) + 1);
  return true;
}

/// The file behind a name now; 0: none.
std::uint64_t inode_of(const char* name) {
  const int file = shm_open(name, O_RDONLY | O_CLOEXEC, 0);
  if (file < 0) return 0;
  struct stat status {};
  const bool known = fstat(file, &status) == 0;
  ::close(file);
  return known ? status.st_ino : 0;
}

}  // namespace

bool SharedRecordsWriter::create(const char* name, const SharedLayout& layout, Reason& reason) {
  close();
  if (!sound(layout)) return refuse(reason, name, "no such streams can be had");
  if (!keep_name(name, name_)) return refuse(reason, name, "the name is too long");
  // A new file in place of the old one: who reads that one keeps it until they look.
  shm_unlink(name);
  const int file = shm_open(name, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR);
  if (file < 0) return refuse(reason, name, strerror(errno));
  const std::uint64_t bytes = total_bytes(layout);
  struct stat status {};
  void* memory = MAP_FAILED;
  // Pages are there from the start: a page fault later could fail, or wait.
  if (posix_fallocate(file, 0, static_cast<off_t>(bytes)) == 0 && fstat(file, &status) == 0)
    memory = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_POPULATE, file, 0);
  const int error = errno;
  ::close(file);
  if (memory == MAP_FAILED) {
    shm_unlink(name);
    return refuse(reason, name, strerror(error));
  }
  bytes_ = bytes;
  inode_ = status.st_ino;
  head_ = new (memory) SharedHead;
  head_->fingerprint = layout.fingerprint;
  head_->bytes = bytes;
  head_->stream_count = static_cast<std::uint32_t>(layout.stream_count);
  head_->writer.store(getpid(), std::memory_order_relaxed);
  std::uint64_t offset = sizeof(SharedHead);
  for (int i = 0; i < layout.stream_count; ++i) {
    head_->streams[i].spec = layout.streams[i];
    head_->streams[i].offset = offset;
    offset += layout.streams[i].slots * slot_bytes(layout.streams[i]);
  }
  head_->magic.store(kMagic, std::memory_order_release);
  return true;
}

void SharedRecordsWriter::write(int stream_index, const void* record) {
  if (head_ == nullptr) return;
  SharedHead::Stream& stream = head_->streams[stream_index];
  const std::uint64_t number = stream.written.load(std::memory_order_relaxed) + 1;
  Word* const slot = slot_at(head_, stream, number);
  slot[0].store(0, std::memory_order_relaxed);
  // Each word is released, so that whoever sees one of them sees the 0 before it.
  const char* from = static_cast<const char*>(record);
  std::uint64_t left = stream.spec.record_bytes;
  for (std::uint64_t i = 1; left > 0; ++i) {
    const std::uint64_t part = left < kWordBytes ? left : kWordBytes;
    std::uint64_t word = 0;
    memcpy(&word, from, part);
    slot[i].store(word, std::memory_order_release);
    from += part;
    left -= part;
  }
  slot[0].store(number, std::memory_order_release);
  stream.written.store(number, std::memory_order_release);
}

void SharedRecordsWriter::close() {
  if (head_ == nullptr) return;
  head_->writer.store(0, std::memory_order_release);
  munmap(head_, bytes_);
  head_ = nullptr;
  if (inode_of(name_) == inode_) shm_unlink(name_);
}

bool SharedRecordsReader::open(const char* name, const SharedLayout& layout, Reason& reason) {
  close();
  if (!sound(layout)) return refuse(reason, name, "no such streams can be had");
  if (!keep_name(name, name_)) return refuse(reason, name, "the name is too long");
  const int file = shm_open(name, O_RDONLY | O_CLOEXEC, 0);
  if (file < 0) return refuse(reason, name, strerror(errno));
  struct stat status {};
  void* memory = MAP_FAILED;
  const std::uint64_t bytes = total_bytes(layout);
  const bool fits = fstat(file, &status) == 0 && static_cast<std::uint64_t>(status.st_size) == bytes;
  if (fits) memory = mmap(nullptr, bytes, PROT_READ, MAP_SHARED, file, 0);
  ::close(file);
  if (!fits) return refuse(reason, name, "is of another size: written by another version");
  if (memory == MAP_FAILED) return refuse(reason, name, strerror(errno));
  head_ = static_cast<const SharedHead*>(memory);
  bytes_ = bytes;
  inode_ = status.st_ino;
  bool same = head_->magic.load(std::memory_order_acquire) == kMagic &&
              head_->layout_version == kSharedLayoutVersion && head_->fingerprint == layout.fingerprint &&
              head_->bytes == bytes && head_->stream_count == static_cast<std::uint32_t>(layout.stream_count);
  std::uint64_t offset = sizeof(SharedHead);
  for (int i = 0; same && i < layout.stream_count; ++i) {
    const SharedHead::Stream& stream = head_->streams[i];
    same = stream.spec.record_bytes == layout.streams[i].record_bytes &&
           stream.spec.slots == layout.streams[i].slots && stream.offset == offset;
    offset += layout.streams[i].slots * slot_bytes(layout.streams[i]);
  }
  if (same) return true;
  close();
  return refuse(reason, name, "is laid out by another version");
}

void SharedRecordsReader::close() {
  if (head_ == nullptr) return;
  munmap(const_cast<SharedHead*>(head_), bytes_);
  head_ = nullptr;
}

std::uint64_t SharedRecordsReader::newest(int stream) const {
  return head_->streams[stream].written.load(std::memory_order_acquire);
}

bool SharedRecordsReader::read(int stream_index, std::uint64_t number, void* record) const {
  if (number == 0) return false;
  const SharedHead::Stream& stream = head_->streams[stream_index];
  const Word* const slot = slot_at(head_, stream, number);
  if (slot[0].load(std::memory_order_acquire) != number) return false;
  char* to = static_cast<char*>(record);
  std::uint64_t left = stream.spec.record_bytes;
  for (std::uint64_t i = 1; left > 0; ++i) {
    const std::uint64_t part = left < kWordBytes ? left : kWordBytes;
    const std::uint64_t word = slot[i].load(std::memory_order_acquire);
    memcpy(to, &word, part);
    to += part;
    left -= part;
  }
  return slot[0].load(std::memory_order_relaxed) == number;
}

bool SharedRecordsReader::next(int stream, std::uint64_t& cursor, std::uint64_t& lost, void* record) const {
  // Bounded: a writer that laps us again and again is let go until the next call.
  const std::uint64_t slots = head_->streams[stream].spec.slots;
  for (std::uint64_t attempt = 0; attempt < slots; ++attempt) {
    const std::uint64_t last = newest(stream);
    if (last <= cursor) return false;
    // The slot after the newest may be being written just now.
    const std::uint64_t oldest = last + 2 > slots ? last + 2 - slots : 1;
    if (cursor + 1 < oldest) {
      lost += oldest - cursor - 1;
      cursor = oldest - 1;
    }
    ++cursor;
    if (read(stream, cursor, record)) return true;
    ++lost;
  }
  return false;
}

bool SharedRecordsReader::abandoned() const {
  const int process = writer();
  if (process == 0 || (kill(process, 0) != 0 && errno == ESRCH)) return true;
  return inode_of(name_) != inode_;
}

int SharedRecordsReader::writer() const {
  return head_->writer.load(std::memory_order_acquire);
}

}  // namespace s4tp::hal::linux_host
