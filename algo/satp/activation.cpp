#include "algo/satp/activation.hpp"

namespace s4tp::satp {
namespace {

constexpr int kStretches = 256;
constexpr double kOne = 32767.0;
constexpr double kStretch = 1.0 / 16.0;  // all three tables span 16

// For the compiler only, when it makes the tables: halved until the series converges fast, squared back.
constexpr double exp_at_compile_time(double x) {
  constexpr int kHalvings = 8;
  const double small = x / 256.0;
  double term = 1.0;
  double sum = 1.0;
  for (int i = 1; i < 12; ++i) {
    term *= small / i;
    sum += term;
  }
  for (int i = 0; i < kHalvings; ++i) sum *= sum;
  return sum;
}

struct Table {
  std::int16_t values[kStretches + 1];
};

constexpr std::int16_t rounded(double x) {
  return static_cast<std::int16_t>(x < 0.0 ? x - 0.5 : x + 0.5);
}

constexpr Table sigmoid_table() {
  Table table{};
  for (int i = 0; i <= kStretches; ++i) {
    table.values[i] = rounded(kOne / (1.0 + exp_at_compile_time(8.0 - kStretch * i)));
  }
  return table;
}

constexpr Table tanh_table() {
  Table table{};
  for (int i = 0; i <= kStretches; ++i) {
    const double e = exp_at_compile_time(2.0 * (8.0 - kStretch * i));
    table.values[i] = rounded(kOne * (1.0 - e) / (1.0 + e));
  }
  return table;
}

constexpr Table exp_table() {
  Table table{};
  for (int i = 0; i <= kStretches; ++i) {
    table.values[i] = rounded(kOne * exp_at_compile_time(-kStretch * i));
  }
  return table;
}

constexpr Table kSigmoid = sigmoid_table();
constexpr Table kTanh = tanh_table();
constexpr Table kExp = exp_table();

// Between two table values, `part` of 2^bits of the way.
std::int32_t between(const Table& table, int index, std::int32_t part, int bits) {
  const std::int32_t a = table.values[index];
  const std::int32_t b = table.values[index + 1];
  return a + (((b - a) * part + (1 << (bits - 1))) >> bits);
}

std::int16_t look_up(const Table& table, std::int16_t x_q12) {
  const std::int32_t from_start = x_q12 + 32768;
  return static_cast<std::int16_t>(between(table, from_start >> 8, from_start & 255, 8));
}

}  // namespace

std::int16_t sigmoid_q15(std::int16_t x_q12) {
  return look_up(kSigmoid, x_q12);
}

std::int16_t tanh_q15(std::int16_t x_q12) {
  return look_up(kTanh, x_q12);
}

std::int32_t exp_minus_q15(std::int32_t x_q8) {
  const std::int32_t index = x_q8 >> 4;
  return index >= kStretches ? 0 : between(kExp, index, x_q8 & 15, 4);
}

}  // namespace s4tp::satp
