// Records in shared memory: states of which the newest counts, events of which each does.
#include "hal/linux/shared_records.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <string>
#include <thread>

#include "tests/support/test_memory.hpp"

namespace s4tp::hal::linux_host {
namespace {

/// Every word says the same, so that a torn copy shows.
struct Record {
  std::uint64_t words[64];
  std::uint32_t tail;
  static Record of(std::uint64_t value) {
    Record record;
    for (std::uint64_t& word : record.words) word = value;
    record.tail = static_cast<std::uint32_t>(value);
    return record;
  }
  [[nodiscard]] bool whole() const {
    for (const std::uint64_t word : words) {
      if (word != words[0]) return false;
    }
    return tail == static_cast<std::uint32_t>(words[0]);
  }
};

constexpr StreamSpec kStreams[] = {{sizeof(Record), kStateSlots}, {sizeof(Record), 8}};
constexpr SharedLayout kLayout{kStreams, 2, 17};

std::string name_of(const char* test) {
  return tests::test_memory(test);
}

class SharedRecords : public testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(writer.create(name.c_str(), kLayout, reason)) << reason.text; }
  std::string name = name_of("records");
  Reason reason;
  SharedRecordsWriter writer;
  SharedRecordsReader reader;
};

// SHM-004 What was written is read, and the newest is the last written.
TEST_F(SharedRecords, TheNewestStateIsRead) {
  ASSERT_TRUE(reader.open(name.c_str(), kLayout, reason)) << reason.text;
  EXPECT_EQ(reader.newest(0), 0U);
  for (std::uint64_t value = 1; value <= 7; ++value) {
    const Record record = Record::of(100 + value);
    writer.write(0, &record);
  }
  ASSERT_EQ(reader.newest(0), 7U);
  Record got;
  ASSERT_TRUE(reader.read(0, 7, &got));
  EXPECT_TRUE(got.whole());
  EXPECT_EQ(got.words[0], 107U);
  EXPECT_TRUE(reader.read(0, 5, &got));
  EXPECT_FALSE(reader.read(0, 4, &got));  // overwritten by the seventh
  EXPECT_FALSE(reader.read(0, 8, &got));
}

// SHM-005 Events come in turn; those that were overwritten are counted as lost.
TEST_F(SharedRecords, EventsComeInTurnAndLostOnesAreCounted) {
  ASSERT_TRUE(reader.open(name.c_str(), kLayout, reason)) << reason.text;
  std::uint64_t cursor = 0;
  std::uint64_t lost = 0;
  Record got;
  EXPECT_FALSE(reader.next(1, cursor, lost, &got));
  for (std::uint64_t value = 1; value <= 5; ++value) {
    const Record record = Record::of(value);
    writer.write(1, &record);
  }
  for (std::uint64_t value = 1; value <= 5; ++value) {
    ASSERT_TRUE(reader.next(1, cursor, lost, &got));
    EXPECT_EQ(got.words[0], value);
  }
  EXPECT_EQ(lost, 0U);
  for (std::uint64_t value = 6; value <= 25; ++value) {
    const Record record = Record::of(value);
    writer.write(1, &record);
  }
  std::uint64_t expected = 25 - 7 + 1;  // of eight slots one may be being written
  while (reader.next(1, cursor, lost, &got)) EXPECT_EQ(got.words[0], expected++);
  EXPECT_EQ(expected, 26U);
  EXPECT_EQ(lost, 20U - 7U);
}

// SHM-004 While a writer goes on as fast as it can, a reader gets whole records only, never an older one
// after a newer.
TEST_F(SharedRecords, ACopyIsWholeOrNotTaken) {
  ASSERT_TRUE(reader.open(name.c_str(), kLayout, reason)) << reason.text;
  std::atomic<bool> stop{false};
  std::thread writing([&] {
    for (std::uint64_t value = 1; !stop; ++value) {
      const Record record = Record::of(value);
      writer.write(0, &record);
    }
  });
  int taken = 0;
  std::uint64_t last = 0;
  // By the clock: on a busy machine the writer may get its first turn long after the reader.
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (taken < 20'000 && std::chrono::steady_clock::now() < end) {
    Record got;
    if (!reader.read(0, reader.newest(0), &got)) {
      std::this_thread::yield();
      continue;
    }
    ASSERT_TRUE(got.whole());
    ASSERT_GE(got.words[0], last);
    last = got.words[0];
    ++taken;
  }
  stop = true;
  writing.join();
  EXPECT_EQ(taken, 20'000);
}

// SHM-003 Another fingerprint, other streams, a file too short and a name nobody has are refused, each with a
// reason.
TEST_F(SharedRecords, AnotherLayoutIsRefused) {
  SharedLayout other = kLayout;
  other.fingerprint = 18;
  EXPECT_FALSE(reader.open(name.c_str(), other, reason));
  EXPECT_NE(std::string(reason.text).find("another version"), std::string::npos);
  constexpr StreamSpec kOther[] = {{sizeof(Record), 8}, {sizeof(Record), kStateSlots}};  // as long in all
  EXPECT_FALSE(reader.open(name.c_str(), SharedLayout{kOther, 2, 17}, reason));
  EXPECT_FALSE(reader.open(name.c_str(), SharedLayout{kStreams, 1, 17}, reason));
  EXPECT_FALSE(reader.open("/s4tp_nobody_has_this", kLayout, reason));
  EXPECT_NE(std::string(reason.text).find("No such file"), std::string::npos);
  const std::string empty = name_of("short");
  const int file = shm_open(empty.c_str(), O_RDWR | O_CREAT, 0600);
  ASSERT_GE(file, 0);
  ASSERT_EQ(ftruncate(file, 100), 0);
  EXPECT_FALSE(reader.open(empty.c_str(), kLayout, reason));
  close(file);
  shm_unlink(empty.c_str());
}

// SHM-001 A second writer takes the name; who reads the first finds it abandoned and what it holds unharmed.
TEST_F(SharedRecords, ANewWriterTakesTheName) {
  const Record record = Record::of(5);
  writer.write(0, &record);
  ASSERT_TRUE(reader.open(name.c_str(), kLayout, reason)) << reason.text;
  EXPECT_FALSE(reader.abandoned());
  EXPECT_EQ(reader.writer(), getpid());
  SharedRecordsWriter second;
  ASSERT_TRUE(second.create(name.c_str(), kLayout, reason)) << reason.text;
  EXPECT_TRUE(reader.abandoned());
  Record got;
  EXPECT_TRUE(reader.read(0, 1, &got));
  writer.close();  // leaves the name to whom it belongs now
  ASSERT_TRUE(reader.open(name.c_str(), kLayout, reason)) << reason.text;
  EXPECT_EQ(reader.newest(0), 0U);
  second.close();
  EXPECT_TRUE(reader.abandoned());
  EXPECT_FALSE(reader.open(name.c_str(), kLayout, reason));
}

// SHM-001 A writer that was killed is noticed, too.
TEST_F(SharedRecords, ADeadWriterIsNoticed) {
  const std::string of_child = name_of("child");
  const pid_t child = fork();
  if (child == 0) {
    SharedRecordsWriter own;
    Reason why;
    const bool made = own.create(of_child.c_str(), kLayout, why);
    if (made) pause();
    _exit(1);
  }
  while (!reader.open(of_child.c_str(), kLayout, reason)) usleep(1000);
  EXPECT_FALSE(reader.abandoned());
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  EXPECT_TRUE(reader.abandoned());
  shm_unlink(of_child.c_str());
}

// What a test that was killed leaves in /dev/shm, the next one removes; what belongs to a living process stays.
TEST(TestMemory, OfTheDeadIsRemoved) {
  const pid_t child = fork();
  if (child == 0) _exit(0);
  waitpid(child, nullptr, 0);
  const std::string of_dead = "/s4tp_test_gone_" + std::to_string(child);
  const std::string of_living = tests::test_memory("stays");
  for (const std::string& name : {of_dead, of_living}) {
    const int file = shm_open(name.c_str(), O_RDWR | O_CREAT, 0600);
    ASSERT_GE(file, 0);
    close(file);
  }
  (void)tests::test_memory("next");
  EXPECT_EQ(shm_unlink(of_dead.c_str()), -1);
  EXPECT_EQ(shm_unlink(of_living.c_str()), 0);
}

// SHM-002 The memory is only this user's, and a reader cannot write to it: it dies of trying.
TEST_F(SharedRecords, ReadersCannotWrite) {
  const int file = shm_open(name.c_str(), O_RDONLY, 0);
  struct stat status {};
  ASSERT_EQ(fstat(file, &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0600U);
  close(file);
  ASSERT_TRUE(reader.open(name.c_str(), kLayout, reason)) << reason.text;
  std::FILE* own = std::fopen("/proc/self/maps", "r");
  int read_only = 0;
  int writable = 0;
  for (char line[512]; std::fgets(line, sizeof line, own) != nullptr;) {
    if (std::string(line).find(name) == std::string::npos) continue;
    (std::string(line).find(" r--s ") != std::string::npos ? read_only : writable) += 1;
  }
  std::fclose(own);
  EXPECT_EQ(read_only, 1);
  EXPECT_EQ(writable, 1);  // the writer's
}

}  // namespace
}  // namespace s4tp::hal::linux_host
