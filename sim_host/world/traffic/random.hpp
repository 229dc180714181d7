#pragma once
/// Random numbers that are the same with every standard library: a fixed engine, distributions of our own.

#include <cstdint>
#include <random>

namespace s4tp::traffic {

class Random {
 public:
  explicit Random(std::uint64_t seed);
  double uniform();  ///< [0, 1)
  double uniform(double low, double high);
  int integer(int low, int high);  ///< both ends included
  double normal(double mean, double deviation);
  double exponential(double mean);

 private:
  std::mt19937_64 engine_;
};

/// Next seed of a chain (SplitMix64): neighbouring seeds give unrelated streams.
[[nodiscard]] std::uint64_t next_seed(std::uint64_t seed);

/// [0, 1), a function of `key`: a draw without a stream.
[[nodiscard]] double hash_uniform(std::uint64_t key);

}  // namespace s4tp::traffic
