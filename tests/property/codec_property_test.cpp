#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <random>
#include <string>
#include <type_traits>
#include <vector>

#include "firmware/wire/codec.hpp"
#include "firmware/wire/generated/s4tp_fields.hpp"

namespace s4tp::wire {
namespace {

using Random = std::mt19937;

template <typename Field>
constexpr bool kIsFloat = std::is_same_v<std::remove_cvref_t<Field>, float>;

/// A value within the range of its signal; the limits themselves come often.
template <typename Field>
void draw(const FieldInfo& info, Field& field, Random& random) {
  const double share = std::uniform_real_distribution<double>(-0.1, 1.1)(random);
  const double value = info.minimum + std::clamp(share, 0.0, 1.0) * (info.maximum - info.minimum);
  field = static_cast<Field>(kIsFloat<Field> ? value : std::floor(value));
}

/// Any bits at all: NaN, infinities, numbers far outside.
template <typename Field>
void draw_bits(Field& field, Random& random) {
  const auto bits = static_cast<std::uint32_t>(random());
  std::memcpy(&field, &bits, sizeof field);
}

/// Half a step, and what float arithmetic costs: two roundings. Within the last step below a limit that is
/// not on the grid (a heading of pi) a whole step.
bool near_enough(const FieldInfo& info, double sent, double received) {
  if (info.step == 1.0) return sent == received;
  const double rounding = 2.0 * std::abs(sent) * std::pow(2.0, -24.0);
  const bool at_the_limit = sent > info.maximum - info.step;
  const double steps = at_the_limit ? 1.0 : 0.5;
  return std::abs(sent - received) <= steps * info.step + rounding;
}

/// All fields of a message, in order.
template <typename Message>
std::vector<double> values_of(Message message) {
  std::vector<double> values;
  for_each_field(message,
                 [&](const FieldInfo&, auto field) { values.push_back(static_cast<double>(field)); });
  return values;
}

template <typename Message>
void check_round_trip(Message message) {
  Frame frame;
  RC_ASSERT(encode(message, frame));
  RC_ASSERT(frame.length == 8);
  Message received;
  RC_ASSERT(decode(frame, received));
  const std::vector<double> values = values_of(message);
  std::size_t i = 0;
  std::vector<std::string> wrong;
  for_each_field(received, [&](const FieldInfo& info, auto field) {
    if (!near_enough(info, values[i++], static_cast<double>(field))) wrong.push_back(info.name);
  });
  RC_ASSERT(wrong.empty());
}

// Named types: RapidCheck compiles once for each, not once for each message.
using OfSeed = std::function<void(std::uint32_t)>;
using OfSeedAndShare = std::function<void(std::uint32_t, std::uint8_t)>;
using OfPayload = std::function<void(std::uint64_t)>;

// WIRE-002, WIRE-003: every message, any values within the ranges: what arrives is within half a step.
TEST(CodecProperty, ValuesArriveWithinHalfAStep) {
  for_each_message([](auto prototype) {
    EXPECT_TRUE(rc::check(OfSeed([&](std::uint32_t seed) {
      Random random(seed);
      auto message = prototype;
      for_each_field(message, [&](const FieldInfo& info, auto& field) { draw(info, field, random); });
      check_round_trip(message);
    })));
  });
}

// WIRE-002: any bits in the fields: either the values arrive, or the frame is as it was.
TEST(CodecProperty, NonsenseIsRefusedOrArrives) {
  for_each_message([](auto prototype) {
    EXPECT_TRUE(rc::check(OfSeedAndShare([&](std::uint32_t seed, std::uint8_t share) {
      Random random(seed);
      auto message = prototype;
      for_each_field(message, [&](const FieldInfo& info, auto& field) {
        if (random() % 256 < share) {
          draw_bits(field, random);
        } else {
          draw(info, field, random);
        }
      });
      Frame frame{0x7FF, 3, {1, 2, 3, 4, 5, 6, 7, 8}};
      const Frame before = frame;
      if (encode(message, frame)) {
        check_round_trip(message);
      } else {
        RC_ASSERT(frame.id == before.id && frame.length == before.length);
        RC_ASSERT(std::memcmp(frame.data, before.data, 8) == 0);
      }
    })));
  });
}

// WIRE-003: any payload: what is decoded lies within the ranges and survives another trip unchanged; what is
// refused leaves the message as it was.
TEST(CodecProperty, AnyPayloadIsRefusedOrStable) {
  for_each_message([](auto prototype) {
    EXPECT_TRUE(rc::check(OfPayload([&](std::uint64_t payload) {
      Frame frame;
      RC_ASSERT(encode(prototype, frame));
      std::memcpy(frame.data, &payload, 8);
      auto message = prototype;
      if (!decode(frame, message)) {
        RC_ASSERT(values_of(message) == values_of(prototype));
        return;
      }
      Frame again;
      auto twice = prototype;
      RC_ASSERT(encode(message, again) && decode(again, twice));
      RC_ASSERT(values_of(message) == values_of(twice));
      bool in_range = true;
      for_each_field(message, [&](const FieldInfo& info, auto field) {
        const double rounding = 1e-6 * std::abs(static_cast<double>(field));
        in_range = in_range && field >= info.minimum - rounding && field <= info.maximum + rounding;
      });
      RC_ASSERT(in_range);
    })));
  });
}

}  // namespace
}  // namespace s4tp::wire
