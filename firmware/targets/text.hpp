#pragma once
/// A line of text in fixed memory, for images without printf. What does not fit is cut.

#include <cstdint>

namespace s4tp::targets {

class Text {
 public:
  Text& operator<<(const char* text);
  Text& operator<<(std::int32_t number);
  Text& operator<<(std::uint32_t number);
  /// `digits` hexadecimal digits, upper case
  Text& hex(std::uint32_t number, int digits);
  [[nodiscard]] const char* c_str() const { return text_; }

 private:
  void append(char character);

  char text_[200] = {};
  int size_ = 0;
};

}  // namespace s4tp::targets
