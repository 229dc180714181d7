// Lines of a candump log: a frame that is one and can be written back, or nothing has changed.

#include <cstring>
#include <string>
#include <vector>

#include "firmware/wire/candump.hpp"
#include "tests/fuzz/input.hpp"

using namespace s4tp;
using fuzz::expect;

namespace {

bool same(const wire::LoggedFrame& a, const wire::LoggedFrame& b) {
  return a.time_us == b.time_us && std::strcmp(a.interface, b.interface) == 0 && a.frame.id == b.frame.id &&
         a.frame.length == b.frame.length && std::memcmp(a.frame.data, b.frame.data, 8) == 0;
}

void read(const std::string& line) {
  const std::vector<char> exact(line.begin(), line.end());  // reading beyond it is seen
  const wire::LoggedFrame before{123, "can7", {0x055, 2, {1, 2}}};
  wire::LoggedFrame logged = before;
  const int size = static_cast<int>(exact.size());
  if (wire::parse_candump(exact.data(), size, logged) != wire::CandumpResult::kFrame) {
    expect(same(logged, before), "a line that is no frame changes nothing");
    return;
  }
  expect(logged.frame.id < 0x800U && logged.frame.length <= 8, "id and length are those of a frame");
  expect(std::memchr(logged.interface, 0, sizeof logged.interface) != nullptr, "the interface's name ends");
  char written[wire::kCandumpLineSize];
  const int written_size = wire::format_candump(logged, written);
  wire::LoggedFrame again;
  expect(written_size < wire::kCandumpLineSize, "a frame's line fits");
  expect(
      wire::parse_candump(written, written_size, again) == wire::CandumpResult::kFrame && same(again, logged),
      "what is written is read back");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t end = std::min(text.find('\n', from), text.size());
    read(text.substr(from, end - from));
    from = end + 1;
  }
  return 0;
}
