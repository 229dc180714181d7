#pragma once
/// Forward differentiation: a value with gradient and Hessian by up to 8 variables.

#include <array>
#include <cmath>
#include <cstddef>

namespace s4tp::benchmark {

inline constexpr std::size_t kVariables = 8;

struct Jet {
  double value = 0.0;
  std::array<double, kVariables> gradient{};
  std::array<std::array<double, kVariables>, kVariables> hessian{};

  Jet() = default;
  Jet(double constant) : value(constant) {}  // NOLINT: constants take part in formulas
  Jet(double at, std::size_t variable) : value(at) { gradient[variable] = 1.0; }
};

/// f(x) with f' and f'' at x.
inline Jet chain(const Jet& x, double f, double first, double second) {
  Jet result(f);
  for (std::size_t i = 0; i < kVariables; ++i) {
    result.gradient[i] = first * x.gradient[i];
    for (std::size_t j = 0; j < kVariables; ++j) {
      result.hessian[i][j] = first * x.hessian[i][j] + second * x.gradient[i] * x.gradient[j];
    }
  }
  return result;
}

inline Jet operator+(const Jet& a, const Jet& b) {
  Jet result(a.value + b.value);
  for (std::size_t i = 0; i < kVariables; ++i) {
    result.gradient[i] = a.gradient[i] + b.gradient[i];
    for (std::size_t j = 0; j < kVariables; ++j) result.hessian[i][j] = a.hessian[i][j] + b.hessian[i][j];
  }
  return result;
}
inline Jet operator-(const Jet& a) {
  return chain(a, -a.value, -1.0, 0.0);
}
inline Jet operator-(const Jet& a, const Jet& b) {
  return a + -b;
}
inline Jet operator*(const Jet& a, const Jet& b) {
  Jet result(a.value * b.value);
  for (std::size_t i = 0; i < kVariables; ++i) {
    result.gradient[i] = a.gradient[i] * b.value + a.value * b.gradient[i];
    for (std::size_t j = 0; j < kVariables; ++j) {
      result.hessian[i][j] = a.hessian[i][j] * b.value + a.value * b.hessian[i][j] +
                             a.gradient[i] * b.gradient[j] + b.gradient[i] * a.gradient[j];
    }
  }
  return result;
}
inline Jet sin(const Jet& x) {
  return chain(x, std::sin(x.value), std::cos(x.value), -std::sin(x.value));
}
inline Jet cos(const Jet& x) {
  return chain(x, std::cos(x.value), -std::sin(x.value), -std::cos(x.value));
}
inline bool operator<(const Jet& a, double b) {
  return a.value < b;
}
inline bool operator>(const Jet& a, double b) {
  return a.value > b;
}

}  // namespace s4tp::benchmark
