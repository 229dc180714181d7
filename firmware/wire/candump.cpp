#include "firmware/wire/candump.hpp"

#include <cstddef>

namespace s4tp::wire {
namespace {

constexpr std::uint64_t kMicrosecondsPerSecond = 1'000'000;
constexpr int kInterfaceMax = 15;
constexpr int kIdDigits = 3;

bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

/// Value of a hexadecimal digit, -1 for any other character.
int hex_value(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return -1;
}

/// Walks over a line; peek() answers '\0' at its end.
class Cursor {
 public:
  Cursor(const char* line, int size) : line_(line), size_(size) {}

  [[nodiscard]] char peek() const { return at_ < size_ ? line_[at_] : '\0'; }
  [[nodiscard]] bool at_end() const { return at_ >= size_; }
  void advance() { ++at_; }

  [[nodiscard]] bool take(char expected) {
    if (at_end() || peek() != expected) return false;
    advance();
    return true;
  }

  /// \return how many characters of white space were passed
  int skip_spaces() {
    int passed = 0;
    for (; !at_end() && is_space(peek()); advance()) ++passed;
    return passed;
  }

  /// Decimal digits up to `most` of them. \return how many there were
  int take_decimal(int most, std::uint64_t& value) {
    int digits = 0;
    for (; digits < most && peek() >= '0' && peek() <= '9'; advance(), ++digits) {
      value = 10U * value + static_cast<std::uint64_t>(peek() - '0');
    }
    return digits;
  }

  [[nodiscard]] bool take_hex(int digits, std::uint32_t& value) {
    for (int i = 0; i < digits; ++i, advance()) {
      const int digit = hex_value(peek());
      if (digit < 0) return false;
      value = 16U * value + static_cast<std::uint32_t>(digit);
    }
    return true;
  }

 private:
  const char* line_;
  int size_;
  int at_ = 0;
};

/// "(seconds.microseconds)"
bool take_time(Cursor& cursor, std::uint64_t& time_us) {
  std::uint64_t seconds = 0;
  std::uint64_t microseconds = 0;
  // 14 digits hold the seconds of 2^64 us.
  if (!cursor.take('(') || cursor.take_decimal(14, seconds) == 0 || !cursor.take('.')) return false;
  if (cursor.take_decimal(6, microseconds) != 6 || !cursor.take(')')) return false;
  if (seconds > (UINT64_MAX - microseconds) / kMicrosecondsPerSecond) return false;
  time_us = seconds * kMicrosecondsPerSecond + microseconds;
  return true;
}

bool take_interface(Cursor& cursor, char (&interface)[kInterfaceMax + 1]) {
  int size = 0;
  for (; cursor.peek() > ' ' && cursor.peek() <= '~'; cursor.advance(), ++size) {
    if (size == kInterfaceMax) return false;
    interface[size] = cursor.peek();
  }
  return size > 0;
}

/// "123#0011..."
bool take_frame(Cursor& cursor, Frame& frame) {
  if (!cursor.take_hex(kIdDigits, frame.id) || frame.id >= 0x800U || !cursor.take('#')) return false;
  while (!cursor.at_end() && !is_space(cursor.peek())) {
    std::uint32_t byte = 0;
    if (frame.length == 8 || !cursor.take_hex(2, byte)) return false;
    frame.data[frame.length++] = static_cast<std::uint8_t>(byte);
  }
  return true;
}

/// Appends to a line that has room for it.
class Writer {
 public:
  explicit Writer(char* line) : line_(line) {}

  void put(char c) { line_[size_++] = c; }
  void put_hex(std::uint32_t value, int digits) {
    for (int shift = 4 * (digits - 1); shift >= 0; shift -= 4)
      put("0123456789ABCDEF"[(value >> shift) & 0xFU]);
  }
  void put_decimal(std::uint64_t value, int least_digits) {
    char digits[20];
    int count = 0;
    for (; value > 0 || count < least_digits; value /= 10U)
      digits[count++] = static_cast<char>('0' + value % 10U);
    while (count > 0) put(digits[--count]);
  }
  [[nodiscard]] int finish() {
    line_[size_] = '\0';
    return size_;
  }

 private:
  char* line_;
  int size_ = 0;
};

}  // namespace

CandumpResult parse_candump(const char* line, int size, LoggedFrame& logged) {
  Cursor cursor(line, size);
  cursor.skip_spaces();
  if (cursor.at_end() || cursor.peek() == '#') return CandumpResult::kSkipped;
  LoggedFrame read;
  if (!take_time(cursor, read.time_us) || cursor.skip_spaces() == 0) return CandumpResult::kMalformed;
  if (!take_interface(cursor, read.interface) || cursor.skip_spaces() == 0) return CandumpResult::kMalformed;
  if (!take_frame(cursor, read.frame)) return CandumpResult::kMalformed;
  cursor.skip_spaces();
  if (cursor.take('R') || cursor.take('T')) cursor.skip_spaces();
  if (!cursor.at_end()) return CandumpResult::kMalformed;
  logged = read;
  return CandumpResult::kFrame;
}

int format_candump(const LoggedFrame& logged, char (&line)[kCandumpLineSize]) {
  Writer writer(line);
  writer.put('(');
  writer.put_decimal(logged.time_us / kMicrosecondsPerSecond, 10);
  writer.put('.');
  writer.put_decimal(logged.time_us % kMicrosecondsPerSecond, 6);
  writer.put(')');
  writer.put(' ');
  const char* interface = logged.interface[0] != '\0' ? logged.interface : "can0";
  for (int i = 0; i < kInterfaceMax && interface[i] != '\0'; ++i) writer.put(interface[i]);
  writer.put(' ');
  writer.put_hex(logged.frame.id, kIdDigits);
  writer.put('#');
  for (int i = 0; i < logged.frame.length && i < 8; ++i) writer.put_hex(logged.frame.data[i], 2);
  return writer.finish();
}

}  // namespace s4tp::wire
