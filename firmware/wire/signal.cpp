#include "firmware/wire/signal.hpp"

#include <cstring>

namespace s4tp::wire {
namespace {

template <typename T>
std::int64_t load_as(const unsigned char* field) {
  T value;
  std::memcpy(&value, field, sizeof value);
  return static_cast<std::int64_t>(value);
}

template <typename T>
void store_as(unsigned char* field, std::int64_t raw) {
  const T value = static_cast<T>(raw);
  std::memcpy(field, &value, sizeof value);
}

bool in_range(const Signal& signal, std::int64_t raw) {
  return raw >= signal.raw_minimum && raw <= static_cast<std::int64_t>(signal.raw_maximum);
}

/// Nearest whole number, ties away from zero. \pre |value| < 2^31, which the physical range ensures
std::int32_t round_to_nearest(float value) {
  const auto whole = static_cast<std::int32_t>(value);
  const float rest = value - static_cast<float>(whole);
  if (rest >= 0.5F) return whole + 1;
  if (rest <= -0.5F) return whole - 1;
  return whole;
}

bool load_scaled(const Signal& signal, const unsigned char* field, std::int64_t& raw) {
  float value = 0.0F;
  std::memcpy(&value, field, sizeof value);
  if (!(value >= signal.minimum && value <= signal.maximum)) return false;
  raw = round_to_nearest(value * signal.denominator / signal.numerator);
  const auto maximum = static_cast<std::int64_t>(signal.raw_maximum);
  if (raw > maximum) raw = maximum;
  return true;
}

bool load(const Signal& signal, const unsigned char* field, std::int64_t& raw) {
  switch (signal.type) {
    case FieldType::kUint8:
      raw = load_as<std::uint8_t>(field);
      break;
    case FieldType::kUint16:
      raw = load_as<std::uint16_t>(field);
      break;
    case FieldType::kUint32:
      raw = load_as<std::uint32_t>(field);
      break;
    case FieldType::kInt8:
      raw = load_as<std::int8_t>(field);
      break;
    case FieldType::kInt16:
      raw = load_as<std::int16_t>(field);
      break;
    case FieldType::kInt32:
      raw = load_as<std::int32_t>(field);
      break;
    case FieldType::kFloat:
      return load_scaled(signal, field, raw);
  }
  return in_range(signal, raw);
}

void store(const Signal& signal, std::int64_t raw, unsigned char* field) {
  switch (signal.type) {
    case FieldType::kUint8:
      store_as<std::uint8_t>(field, raw);
      break;
    case FieldType::kUint16:
      store_as<std::uint16_t>(field, raw);
      break;
    case FieldType::kUint32:
      store_as<std::uint32_t>(field, raw);
      break;
    case FieldType::kInt8:
      store_as<std::int8_t>(field, raw);
      break;
    case FieldType::kInt16:
      store_as<std::int16_t>(field, raw);
      break;
    case FieldType::kInt32:
      store_as<std::int32_t>(field, raw);
      break;
    case FieldType::kFloat: {
      // By way of int32, so that no compiler calls a 64-bit conversion routine of its own.
      const float quanta = static_cast<float>(static_cast<std::int32_t>(raw));
      const float value = quanta * signal.numerator / signal.denominator;
      std::memcpy(field, &value, sizeof value);
      break;
    }
  }
}

std::uint64_t mask(const Signal& signal) {
  return (std::uint64_t{1} << signal.size) - 1U;
}

std::int64_t extract(const Signal& signal, std::uint64_t payload) {
  const std::uint64_t bits = (payload >> signal.first_bit) & mask(signal);
  const std::uint64_t sign = std::uint64_t{1} << (signal.size - 1U);
  const auto raw = static_cast<std::int64_t>(bits);
  return signal.is_signed && (bits & sign) != 0U ? raw - static_cast<std::int64_t>(sign << 1U) : raw;
}

}  // namespace

bool pack(const MessageLayout& layout, const void* message, Frame& frame) {
  const auto* bytes = static_cast<const unsigned char*>(message);
  std::uint64_t payload = 0;
  for (int i = 0; i < layout.signal_count; ++i) {
    const Signal& signal = layout.signals[i];
    std::int64_t raw = 0;
    if (!load(signal, bytes + signal.offset, raw)) return false;
    payload |= (static_cast<std::uint64_t>(raw) & mask(signal)) << signal.first_bit;
  }
  frame.id = layout.id;
  frame.length = layout.length;
  for (int i = 0; i < 8; ++i) frame.data[i] = static_cast<std::uint8_t>(payload >> (8 * i));
  return true;
}

bool unpack(const MessageLayout& layout, const Frame& frame, void* message) {
  if (frame.id != layout.id || frame.length != layout.length) return false;
  std::uint64_t payload = 0;
  for (int i = 0; i < 8; ++i) payload |= static_cast<std::uint64_t>(frame.data[i]) << (8 * i);
  for (int i = 0; i < layout.signal_count; ++i) {
    if (!in_range(layout.signals[i], extract(layout.signals[i], payload))) return false;
  }
  auto* bytes = static_cast<unsigned char*>(message);
  for (int i = 0; i < layout.signal_count; ++i) {
    const Signal& signal = layout.signals[i];
    store(signal, extract(signal, payload), bytes + signal.offset);
  }
  return true;
}

}  // namespace s4tp::wire
