#include "sim_host/sumo/traci_message.hpp"

#include <bit>

namespace s4tp::sumo::traci {
namespace {

// Type bytes.
constexpr int kPosition2d = 0x01;
constexpr int kUnsignedByte = 0x07;
constexpr int kByte = 0x08;
constexpr int kInteger = 0x09;
constexpr int kReal = 0x0B;
constexpr int kText = 0x0C;
constexpr int kTexts = 0x0E;
constexpr int kCompound = 0x0F;

template <typename Unsigned>
void put(std::vector<std::uint8_t>& bytes, Unsigned value) {
  for (int shift = 8 * (static_cast<int>(sizeof value) - 1); shift >= 0; shift -= 8) {
    bytes.push_back(static_cast<std::uint8_t>(value >> shift));
  }
}

template <typename Unsigned>
Unsigned get(std::span<const std::uint8_t> bytes) {
  Unsigned value = 0;
  for (const std::uint8_t byte : bytes) {
    value = static_cast<Unsigned>(value << 8U | byte);
  }
  return value;
}

}  // namespace

Writer& Writer::byte(int value) {
  bytes_.push_back(static_cast<std::uint8_t>(value));
  return *this;
}

Writer& Writer::integer(int value) {
  put(bytes_, static_cast<std::uint32_t>(value));
  return *this;
}

Writer& Writer::real(double value) {
  put(bytes_, std::bit_cast<std::uint64_t>(value));
  return *this;
}

Writer& Writer::text(const std::string& value) {
  integer(static_cast<int>(value.size()));
  bytes_.insert(bytes_.end(), value.begin(), value.end());
  return *this;
}

Writer& Writer::typed_byte(int value) {
  return byte(kByte).byte(value);
}

Writer& Writer::typed_integer(int value) {
  return byte(kInteger).integer(value);
}

Writer& Writer::typed_real(double value) {
  return byte(kReal).real(value);
}

Writer& Writer::typed_text(const std::string& value) {
  return byte(kText).text(value);
}

Writer& Writer::typed_texts(const std::vector<std::string>& value) {
  byte(kTexts).integer(static_cast<int>(value.size()));
  for (const std::string& each : value) {
    text(each);
  }
  return *this;
}

Writer& Writer::compound(int items) {
  return byte(kCompound).integer(items);
}

Writer& Writer::append(const Writer& other) {
  bytes_.insert(bytes_.end(), other.bytes_.begin(), other.bytes_.end());
  return *this;
}

std::span<const std::uint8_t> Reader::take(std::size_t wanted) {
  if (wanted > bytes_.size()) {
    throw Error("SUMO's answer ends " + std::to_string(wanted - bytes_.size()) + " bytes early");
  }
  const std::span<const std::uint8_t> taken = bytes_.first(wanted);
  bytes_ = bytes_.subspan(wanted);
  return taken;
}

int Reader::byte() {
  return take(1)[0];
}

int Reader::integer() {
  return static_cast<int>(get<std::uint32_t>(take(4)));
}

double Reader::real() {
  return std::bit_cast<double>(get<std::uint64_t>(take(8)));
}

std::size_t Reader::count() {
  const int value = integer();
  if (value < 0) {
    throw Error("SUMO's answer holds a length of " + std::to_string(value));
  }
  return static_cast<std::size_t>(value);
}

std::string Reader::text() {
  const std::span<const std::uint8_t> taken = take(count());
  return {taken.begin(), taken.end()};
}

Value Reader::typed() {
  const int type = byte();
  switch (type) {
    case kUnsignedByte:
      return byte();
    case kByte:
      return static_cast<int>(static_cast<std::int8_t>(byte()));
    case kInteger:
      return integer();
    case kReal:
      return real();
    case kText:
      return text();
    case kTexts: {
      std::vector<std::string> all;
      for (std::size_t left = count(); left > 0; --left) {
        all.push_back(text());
      }
      return all;
    }
    case kPosition2d: {
      const double x = real();
      return map::Vec2{x, real()};
    }
    default:
      throw Error("SUMO's answer holds a value of type " + std::to_string(type) + ", which is not expected");
  }
}

Reader Reader::command() {
  std::size_t length = static_cast<std::size_t>(byte());
  std::size_t own = 1;
  if (length == 0) {
    length = count();
    own = 5;
  }
  if (length < own) {
    throw Error("SUMO's answer holds a command of " + std::to_string(length) + " bytes");
  }
  return Reader(take(length - own));
}

std::vector<std::uint8_t> message(int command, const Writer& content) {
  constexpr std::size_t kLongest = 255;  // that one byte of length can say
  const std::size_t length = content.bytes().size() + 2;
  Writer body;
  if (length <= kLongest) {
    body.byte(static_cast<int>(length));
  } else {
    body.byte(0).integer(static_cast<int>(length + 4));
  }
  body.byte(command).append(content);
  Writer whole;
  whole.integer(static_cast<int>(body.bytes().size() + 4)).append(body);
  return whole.bytes();
}

}  // namespace s4tp::sumo::traci
