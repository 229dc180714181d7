#include "algo/satp/activation.hpp"

#include "algo/satp/lanes.hpp"

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
  Stretch stretches[kStretches];
};

constexpr std::int16_t rounded(double x) {
  return static_cast<std::int16_t>(x < 0.0 ? x - 0.5 : x + 0.5);
}

constexpr double sigmoid_at(int i) {
  return 1.0 / (1.0 + exp_at_compile_time(8.0 - kStretch * i));
}

constexpr double tanh_at(int i) {
  const double e = exp_at_compile_time(2.0 * (8.0 - kStretch * i));
  return (1.0 - e) / (1.0 + e);
}

constexpr double exp_minus_at(int i) {
  return exp_at_compile_time(-kStretch * i);
}

constexpr Table table_of(double (*function)(int)) {
  Table table{};
  for (int i = 0; i < kStretches; ++i) {
    const std::int16_t value = rounded(kOne * function(i));
    table.stretches[i] = {value, static_cast<std::int16_t>(rounded(kOne * function(i + 1)) - value)};
  }
  return table;
}

// Beside the weights that they are used with: on a board the code's flash has no room to spare, the weights' bank has.
[[gnu::section(".weights")]] constexpr Table kSigmoid = table_of(sigmoid_at);
[[gnu::section(".weights")]] constexpr Table kTanh = table_of(tanh_at);
[[gnu::section(".weights")]] constexpr Table kExp = table_of(exp_minus_at);

}  // namespace

std::int16_t sigmoid_q15(std::int16_t x_q12) {
  plain::look_up(kSigmoid.stretches, &x_q12, 1);
  return x_q12;
}

std::int16_t tanh_q15(std::int16_t x_q12) {
  plain::look_up(kTanh.stretches, &x_q12, 1);
  return x_q12;
}

void sigmoid_q15(std::int16_t* values, int count) {
  lanes::look_up(kSigmoid.stretches, values, count);
}

void tanh_q15(std::int16_t* values, int count) {
  lanes::look_up(kTanh.stretches, values, count);
}

std::int32_t exp_minus_q15(std::int32_t x_q8) {
  const std::int32_t index = x_q8 >> 4;
  if (index >= kStretches) return 0;
  const Stretch& stretch = kExp.stretches[index];
  return stretch.value + ((stretch.rise * (x_q8 & 15) + 8) >> 4);
}

}  // namespace s4tp::satp
