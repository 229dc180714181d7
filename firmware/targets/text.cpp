#include "firmware/targets/text.hpp"

namespace s4tp::targets {

void Text::append(char character) {
  if (size_ + 1 < static_cast<int>(sizeof text_)) text_[size_++] = character;
}

Text& Text::operator<<(const char* text) {
  for (; *text != '\0'; ++text) append(*text);
  return *this;
}

Text& Text::operator<<(std::uint32_t number) {
  char digits[10];
  int count = 0;
  do {
    digits[count++] = static_cast<char>('0' + number % 10);
    number /= 10;
  } while (number != 0);
  while (count > 0) append(digits[--count]);
  return *this;
}

Text& Text::operator<<(std::int32_t number) {
  if (number < 0) append('-');
  const auto bits = static_cast<std::uint32_t>(number);
  return *this << (number < 0 ? 0U - bits : bits);
}

Text& Text::hex(std::uint32_t number, int digits) {
  for (int digit = digits - 1; digit >= 0; --digit) append("0123456789ABCDEF"[(number >> (4 * digit)) & 0xF]);
  return *this;
}

}  // namespace s4tp::targets
