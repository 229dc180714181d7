// A serial line's characters: what is read as a frame is one, and its line is read back the same.

#include <cctype>
#include <cstdio>
#include <cstring>
#include <string>

#include "hal/slcan.hpp"
#include "tests/fuzz/input.hpp"

using namespace s4tp;
using fuzz::expect;

namespace {

bool same(const hal::CanFrame& a, const hal::CanFrame& b) {
  return a.id == b.id && a.length == b.length && std::memcmp(a.data, b.data, sizeof a.data) == 0;
}

void check(const hal::CanFrame& frame) {
  expect(frame.id < 0x800U && frame.length <= 8, "id and length are those of a frame");
  for (std::size_t i = frame.length; i < sizeof frame.data; ++i)
    expect(frame.data[i] == 0, "zeros behind the data");
  char line[hal::kSlcanLineSize];
  const int size = hal::format_slcan(frame, line);
  expect(size > 0 && size <= hal::kSlcanLineSize, "a frame has a line");
  hal::SlcanParser parser;
  hal::CanFrame again;
  for (int i = 0; i < size; ++i) {
    const bool last = i + 1 == size;
    expect((parser.take(line[i], again) == hal::SlcanEvent::kFrame) == last, "a line is one frame");
  }
  expect(same(again, frame), "what is written is read back");
}

/// SLCAN-008, by the letter: the line that ends here, line feeds apart, begins with t and the three digits of the id.
class PlainWatch {
 public:
  explicit PlainWatch(std::uint32_t id) : id_(id) {}
  bool take(char character) {
    if (character == '\n') return false;
    if (character != '\r' && character != '\a') {
      // No more than a string keeps in itself: its growth is libstdc++'s, which the memory sanitizer does not see into.
      if (line_.size() < 4) line_ += character;
      return false;
    }
    char begin[8];
    std::snprintf(begin, sizeof begin, "t%03x", static_cast<unsigned>(id_));
    std::string head = line_;
    for (std::size_t i = 1; i < head.size(); ++i)
      head[i] = static_cast<char>(std::tolower(static_cast<unsigned char>(head[i])));
    line_.clear();
    return character == '\r' && head == begin;
  }

 private:
  std::uint32_t id_;
  std::string line_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  hal::SlcanParser parser;
  constexpr std::uint32_t kWatched = 0x12A;
  hal::SlcanWatch watch(kWatched);
  PlainWatch plain(kWatched);
  const hal::CanFrame before{.id = 0x055, .length = 1, .data = {7}};
  for (std::size_t i = 0; i < size; ++i) {
    hal::CanFrame frame = before;
    const auto character = static_cast<char>(data[i]);
    const bool ends = watch.take(character);
    expect(ends == plain.take(character), "the watch sees the id's lines, and no others");
    const hal::SlcanEvent event = parser.take(character, frame);
    if (event == hal::SlcanEvent::kFrame)
      expect(ends == (frame.id == kWatched), "a frame of the id watched is seen");
    if (event == hal::SlcanEvent::kFrame) {
      check(frame);
    } else {
      expect(same(frame, before), "what is no frame changes nothing");
    }
    expect(event <= hal::SlcanEvent::kGarbage, "an event is one of the seven");
  }
  hal::CanFrame frame;
  static_cast<void>(parser.take('\r', frame));
  for (const char letter : {'t', '1', '2', '3', '0'}) static_cast<void>(parser.take(letter, frame));
  expect(parser.take('\r', frame) == hal::SlcanEvent::kFrame && frame.id == 0x123,
         "it reads on after anything");
  // Of any frame a line is written, or none.
  fuzz::Input input(data, size);
  hal::CanFrame any;
  any.id = input.take<std::uint32_t>() & (input.byte() % 2 == 0 ? 0x7FFU : 0xFFFFFFFFU);
  any.length = static_cast<std::uint8_t>(input.below(12));
  input.copy(any.data, 8);
  char line[hal::kSlcanLineSize];
  const int written = hal::format_slcan(any, line);
  expect(written <= hal::kSlcanLineSize && (written > 0) == (any.id < 0x800U && any.length <= 8),
         "frames of ours have a line, others none");
  return 0;
}
