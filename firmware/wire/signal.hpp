#pragma once
/// Packs and unpacks the signals of a message from descriptors, so that the generated codec is mostly data.
/// Little-endian bit order, as "@1" in a DBC: bit i of the payload is bit i % 8 of byte i / 8.

#include <cstdint>

#include "firmware/wire/frame.hpp"

namespace s4tp::wire {

/// Type of the field that holds a signal. Scaled signals are kFloat.
enum class FieldType : std::uint8_t { kUint8, kUint16, kUint32, kInt8, kInt16, kInt32, kFloat };

/// One signal of the DBC and the field of the message struct that carries it.
/// physical value = raw * numerator / denominator; two small whole numbers where the factor allows it, so
/// that a decoded value is the float nearest to the decimal one.
struct Signal {
  std::uint8_t offset;  ///< of the field in the struct
  FieldType type;
  std::uint8_t first_bit;
  std::uint8_t size;  ///< bits
  bool is_signed;
  std::int32_t raw_minimum;
  std::uint32_t raw_maximum;
  float numerator;  ///< from here on of kFloat only
  float denominator;
  float minimum;  ///< physical
  float maximum;
};

struct MessageLayout {
  std::uint32_t id;
  std::uint8_t length;
  const Signal* signals;
  int signal_count;
};

/// \param message  standard-layout struct the layout was made for
/// \return false, with `frame` untouched, when a value is NaN or outside its range
/// \note a value within its range that rounds to more than the bits hold (a heading just below pi) takes the
/// largest raw value
[[nodiscard]] bool pack(const MessageLayout& layout, const void* message, Frame& frame);

/// \return false, with `message` untouched, when id or length differ or a raw value is outside its range
[[nodiscard]] bool unpack(const MessageLayout& layout, const Frame& frame, void* message);

}  // namespace s4tp::wire
