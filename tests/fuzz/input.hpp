#pragma once
/// What the fuzz targets share: an input taken apart from its front, and oracles that end the process.

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

namespace s4tp::fuzz {

/// Beyond its end an input is zeros, so that every prefix of an input is one, too.
class Input {
 public:
  Input(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}

  [[nodiscard]] bool empty() const { return left_ == 0; }

  void copy(void* to, std::size_t size) {
    const std::size_t there = size < left_ ? size : left_;
    std::memset(to, 0, size);
    if (there > 0) std::memcpy(to, data_, there);  // of nothing, data_ may be null
    data_ += there;
    left_ -= there;
  }
  /// The next bytes as they are: a float may be anything at all.
  template <class Number>
  [[nodiscard]] Number take() {
    Number number;
    copy(&number, sizeof number);
    return number;
  }
  [[nodiscard]] std::uint8_t byte() { return take<std::uint8_t>(); }
  /// 0 .. bound - 1. \pre bound <= 256
  [[nodiscard]] int below(int bound) { return byte() % bound; }
  /// low .. high in 65535 steps, both included
  [[nodiscard]] float real(float low, float high) {
    return low + (high - low) * (static_cast<float>(take<std::uint16_t>()) / 65535.0F);
  }
  [[nodiscard]] std::string rest() {
    std::string text(left_, '\0');
    copy(text.data(), text.size());
    return text;
  }

 private:
  const std::uint8_t* data_;
  std::size_t left_;
};

/// An oracle: libFuzzer keeps the input of a process that aborts.
inline void expect(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "fuzz: does not hold: %s\n", what);
  std::abort();
}

}  // namespace s4tp::fuzz
