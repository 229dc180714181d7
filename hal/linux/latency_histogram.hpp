#pragma once
/// How late a periodic task was, each time: counts by size in fixed memory, nothing to slow the task down.
///
/// \code
///   bucket width [us]   1 1 1 .. 1 | 2 2 .. 2 | 4 4 .. 4 | ..  | 524288 ..
///   from [us]           0          64         128        256    2^24
/// \endcode

#include <cstdint>

namespace s4tp::hal::linux_host {

class LatencyHistogram {
 public:
  /// RT-001 Values below 64 us are kept as they are, larger ones to 1/32 of themselves.
  void add(std::uint32_t latency_us);
  /// Ticks skipped, or begun a whole period late or later.
  void add_slips(std::uint32_t slips) { slips_ += slips; }

  [[nodiscard]] std::uint32_t count() const { return count_; }
  [[nodiscard]] std::uint32_t slips() const { return slips_; }
  [[nodiscard]] std::uint32_t min_us() const { return count_ == 0 ? 0 : min_us_; }
  [[nodiscard]] std::uint32_t max_us() const { return max_us_; }
  /// RT-002 The smallest latency that `per_myriad` of 10,000 wake-ups did not exceed, never told too small:
  /// the upper end of its bucket, at most the maximum. 0 when nothing was counted.
  [[nodiscard]] std::uint32_t quantile_us(std::uint32_t per_myriad) const;
  /// RT-003 How many lie in from_us .. to_us - 1; exact where both are powers of two (or 0).
  [[nodiscard]] std::uint32_t count_in(std::uint32_t from_us, std::uint32_t to_us) const;

 private:
  static constexpr std::uint32_t kExact = 64;
  static constexpr std::uint32_t kPerOctave = 32;
  static constexpr std::uint32_t kFirstOctave = 6;  // 2^6 = kExact
  static constexpr std::uint32_t kOctaves = 18;     // the last one ends at 2^24 us = 17 s
  static constexpr std::uint32_t kBuckets = kExact + kPerOctave * kOctaves;

  [[nodiscard]] static std::uint32_t bucket_of(std::uint32_t latency_us);
  /// First value of a bucket.
  [[nodiscard]] static std::uint32_t begin_us(std::uint32_t bucket);

  std::uint32_t counts_[kBuckets] = {};
  std::uint32_t count_ = 0;
  std::uint32_t slips_ = 0;
  std::uint32_t min_us_ = UINT32_MAX;
  std::uint32_t max_us_ = 0;
};

}  // namespace s4tp::hal::linux_host
