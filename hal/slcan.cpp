#include "hal/slcan.hpp"

namespace s4tp::hal {
namespace {

constexpr std::uint32_t kLargestId = 0x7FF;
constexpr int kTimeDigits = 4;

char digit(std::uint32_t value) {
  return "0123456789ABCDEF"[value & 0xFU];
}

/// \return -1 when it is none
int value_of(char character) {
  if (character >= '0' && character <= '9') return character - '0';
  if (character >= 'A' && character <= 'F') return character - 'A' + 10;
  if (character >= 'a' && character <= 'f') return character - 'a' + 10;
  return -1;
}

/// A run of hexadecimal digits. \return false when one of them is none
bool read_hex(const char* text, int digits, std::uint32_t& value) {
  value = 0;
  for (int i = 0; i < digits; ++i) {
    const int one = value_of(text[i]);
    if (one < 0) return false;
    value = value * 16U + static_cast<std::uint32_t>(one);
  }
  return true;
}

/// Letter, id, length, data and perhaps a time, as `letter` wants them. \return false when malformed
bool read_frame(const char* line, int size, CanFrame& frame) {
  const bool extended = line[0] == 'T' || line[0] == 'R';
  const bool remote = line[0] == 'r' || line[0] == 'R';
  const int id_digits = extended ? 8 : 3;
  const int head = 1 + id_digits + 1;
  std::uint32_t length = 0;
  CanFrame read;
  if (size < head || !read_hex(line + 1, id_digits, read.id) || !read_hex(line + head - 1, 1, length) ||
      length > 8) {
    return false;
  }
  const int bytes = remote ? 0 : static_cast<int>(length);
  const int end = head + 2 * bytes;
  std::uint32_t value = 0;
  if (size != end && (size != end + kTimeDigits || !read_hex(line + end, kTimeDigits, value))) return false;
  for (int i = 0; i < bytes; ++i) {
    if (!read_hex(line + head + 2 * i, 2, value)) return false;
    read.data[i] = static_cast<std::uint8_t>(value);
  }
  read.length = static_cast<std::uint8_t>(length);
  frame = read;
  return extended || read.id <= kLargestId;
}

bool is_command(const char* line, int size) {
  bool known = false;
  for (const char* letter = "SsOLlCVvNnFMmWXUQPAEZz"; *letter != '\0'; ++letter) {
    known = known || line[0] == *letter;
  }
  for (int i = 1; i < size; ++i) {
    const char c = line[i];
    known = known && ((c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'));
  }
  return known;
}

}  // namespace

int format_slcan(const CanFrame& frame, char (&line)[kSlcanLineSize]) {
  if (frame.id > kLargestId || frame.length > 8) return 0;
  int size = 0;
  line[size++] = 't';
  for (std::uint32_t shift = 12; shift > 0;) line[size++] = digit(frame.id >> (shift -= 4));
  line[size++] = digit(frame.length);
  for (int i = 0; i < frame.length; ++i) {
    line[size++] = digit(static_cast<std::uint32_t>(frame.data[i]) >> 4U);
    line[size++] = digit(frame.data[i]);
  }
  line[size++] = '\r';
  return size;
}

SlcanEvent SlcanParser::take(char character, CanFrame& frame) {
  if (character == '\a') {
    size_ = 0;
    return SlcanEvent::kRefused;
  }
  if (character == '\n') return SlcanEvent::kNothing;  // terminals add it
  if (character != '\r') {
    if (size_ < kLongest) line_[size_] = character;
    if (size_ <= kLongest) ++size_;
    return SlcanEvent::kNothing;
  }
  const SlcanEvent event = judge(frame);
  size_ = 0;
  return event;
}

bool SlcanWatch::take(char character) {
  if (character == '\r' || character == '\a') {
    const bool ends = character == '\r' && matched_ == kBegin;
    matched_ = 0;
    return ends;
  }
  if (character == '\n' || matched_ < 0 || matched_ == kBegin) return false;
  const auto wanted = static_cast<int>(id_ >> static_cast<unsigned>(4 * (kBegin - 1 - matched_)) & 0xFU);
  const bool fits = matched_ == 0 ? character == 't' : value_of(character) == wanted;
  matched_ = fits ? matched_ + 1 : -1;
  return false;
}

SlcanEvent SlcanParser::judge(CanFrame& frame) const {
  if (size_ == 0) return SlcanEvent::kDone;
  if (size_ > kLongest) return SlcanEvent::kGarbage;
  const char letter = line_[0];
  if (size_ == 1 && (letter == 'z' || letter == 'Z')) return SlcanEvent::kDone;
  if (letter == 't' || letter == 'T' || letter == 'r' || letter == 'R') {
    CanFrame read;
    if (!read_frame(line_, size_, read)) return SlcanEvent::kGarbage;
    if (letter != 't') return SlcanEvent::kForeign;
    frame = read;
    return SlcanEvent::kFrame;
  }
  return is_command(line_, size_) ? SlcanEvent::kCommand : SlcanEvent::kGarbage;
}

}  // namespace s4tp::hal
