#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/wire/candump.hpp"

namespace s4tp::wire {
namespace {

LoggedFrame any_logged_frame() {
  LoggedFrame logged;
  logged.time_us = *rc::gen::arbitrary<std::uint64_t>();
  const auto name = *rc::gen::container<std::string>(rc::gen::inRange('!', '\x7F'));
  std::memcpy(logged.interface, name.data(), std::min<std::size_t>(name.size(), 15));
  logged.frame.id = *rc::gen::inRange<std::uint32_t>(0, 0x800);
  logged.frame.length = *rc::gen::inRange<std::uint8_t>(0, 9);
  for (int i = 0; i < logged.frame.length; ++i) logged.frame.data[i] = *rc::gen::arbitrary<std::uint8_t>();
  return logged;
}

bool same(const LoggedFrame& a, const LoggedFrame& b) {
  return a.time_us == b.time_us && std::strcmp(a.interface, b.interface) == 0 && a.frame.id == b.frame.id &&
         a.frame.length == b.frame.length && std::memcmp(a.frame.data, b.frame.data, 8) == 0;
}

// WIRE-040: what is written is read back, and written again it is the same line.
TEST(CandumpProperty, WrittenLinesAreReadBack) {
  EXPECT_TRUE(rc::check([] {
    LoggedFrame logged = any_logged_frame();
    char line[kCandumpLineSize];
    const int size = format_candump(logged, line);
    RC_ASSERT(size == static_cast<int>(std::strlen(line)) && size < kCandumpLineSize);
    LoggedFrame read;
    RC_ASSERT(parse_candump(line, size, read) == CandumpResult::kFrame);
    if (logged.interface[0] == '\0') std::memcpy(logged.interface, "can0", 5);
    RC_ASSERT(same(read, logged));
  }));
}

// WIRE-042: a good line with characters replaced, lost or added: unless it is still one, nothing changes. The
// text stands in a buffer of its own size, so that a sanitizer sees reading beyond it.
TEST(CandumpProperty, DamagedLinesChangeNothing) {
  EXPECT_TRUE(rc::check([] {
    char line[kCandumpLineSize];
    const int size = format_candump(any_logged_frame(), line);
    std::string text(line, static_cast<std::size_t>(size));
    for (int damage = *rc::gen::inRange(0, 4); damage > 0 && !text.empty(); --damage) {
      const auto at = *rc::gen::inRange<std::size_t>(0, text.size());
      switch (*rc::gen::inRange(0, 4)) {
        case 0:
          text[at] = *rc::gen::arbitrary<char>();
          break;
        case 1:
          text.erase(at, 1);
          break;
        case 2:
          text.insert(at, 1, *rc::gen::arbitrary<char>());
          break;
        default:
          text.resize(at);
          break;
      }
    }
    const std::vector<char> exact(text.begin(), text.end());
    const LoggedFrame before{123, "can7", {0x055, 2, {1, 2}}};
    LoggedFrame logged = before;
    if (parse_candump(exact.data(), static_cast<int>(exact.size()), logged) == CandumpResult::kFrame) {
      RC_ASSERT(logged.frame.id < 0x800U && logged.frame.length <= 8);
      RC_ASSERT(std::string_view(logged.interface, sizeof logged.interface).find('\0') !=
                std::string_view::npos);
    } else {
      RC_ASSERT(same(logged, before));
    }
  }));
}

}  // namespace
}  // namespace s4tp::wire
