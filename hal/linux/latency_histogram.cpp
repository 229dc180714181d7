#include "hal/linux/latency_histogram.hpp"

namespace s4tp::hal::linux_host {

std::uint32_t LatencyHistogram::bucket_of(std::uint32_t latency_us) {
  if (latency_us < kExact) return latency_us;
  std::uint32_t octave = 0;
  while (octave + 1 < kOctaves && (latency_us >> (kFirstOctave + octave + 1)) != 0) ++octave;
  const std::uint32_t within = (latency_us >> (octave + 1)) - kPerOctave;
  return kExact + octave * kPerOctave + (within < kPerOctave ? within : kPerOctave - 1);
}

std::uint32_t LatencyHistogram::begin_us(std::uint32_t bucket) {
  if (bucket < kExact) return bucket;
  const std::uint32_t octave = (bucket - kExact) / kPerOctave;
  return (kPerOctave + (bucket - kExact) % kPerOctave) << (octave + 1);
}

void LatencyHistogram::add(std::uint32_t latency_us) {
  ++counts_[bucket_of(latency_us)];
  ++count_;
  if (latency_us < min_us_) min_us_ = latency_us;
  if (latency_us > max_us_) max_us_ = latency_us;
}

std::uint32_t LatencyHistogram::quantile_us(std::uint32_t per_myriad) const {
  const std::uint64_t wanted = (std::uint64_t{count_} * per_myriad + 9999U) / 10'000U;
  std::uint64_t seen = 0;
  for (std::uint32_t bucket = 0; bucket + 1 < kBuckets; ++bucket) {
    seen += counts_[bucket];
    if (seen < wanted || seen == 0) continue;
    const std::uint32_t last_us = begin_us(bucket + 1) - 1;
    return last_us < max_us_ ? last_us : max_us_;
  }
  return max_us_;
}

std::uint32_t LatencyHistogram::count_in(std::uint32_t from_us, std::uint32_t to_us) const {
  std::uint32_t sum = 0;
  for (std::uint32_t bucket = 0; bucket < kBuckets; ++bucket) {
    const std::uint32_t begin = begin_us(bucket);
    if (begin >= from_us && begin < to_us) sum += counts_[bucket];
  }
  return sum;
}

}  // namespace s4tp::hal::linux_host
