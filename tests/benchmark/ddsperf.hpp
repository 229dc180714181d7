#pragma once
/// What Cyclone DDS's own tool measures on this machine.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace s4tp::benchmark {

/// The value below which that share of them lies; 0 of none.
inline double at(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

/// ddsperf's own figures for messages of one size: half a round trip at 10 Hz, and what is lost of 100 a second.
struct Reference {
  int bytes = 0;
  double median_us = 0.0;  ///< the median second's
  double most_us = 0.0;
  long sent = 0;
  long lost = 0;
};

inline std::vector<std::string> lines_of(FILE* pipe) {
  std::vector<std::string> lines;
  char line[512];
  while (pipe != nullptr && fgets(line, sizeof line, pipe) != nullptr) lines.emplace_back(line);
  if (pipe != nullptr) pclose(pipe);
  return lines;
}

/// The number that follows `name`.
inline double after(const std::string& line, const std::string& name) {
  const std::size_t at = line.find(name);
  return at == std::string::npos ? 0.0 : std::atof(line.c_str() + at + name.size());
}

inline Reference ddsperf(int bytes, int seconds, std::uint32_t domain) {
  Reference reference;
  reference.bytes = bytes;
  const auto start = [domain](int duration_s, const std::string& mode) {
    return popen(
        ("exec ddsperf -i " + std::to_string(domain) + " -D " + std::to_string(duration_s) + " " + mode)
            .c_str(),
        "r");
  };
  const std::string size = " size " + std::to_string(bytes);
  FILE* const pong = start(seconds + 1, "pong");
  std::vector<double> medians;
  for (const std::string& line : lines_of(start(seconds, "ping 10Hz" + size))) {
    if (line.find(" mean ") == std::string::npos) continue;
    medians.push_back(after(line, "50% "));
    reference.most_us = std::max(reference.most_us, after(line, "max "));
  }
  (void)lines_of(pong);
  reference.median_us = at(medians, 0.5);
  FILE* const sub = start(seconds + 1, "sub");
  (void)lines_of(start(seconds, "pub 100Hz" + size));
  for (const std::string& line : lines_of(sub)) {
    if (line.find(" total ") == std::string::npos) continue;
    reference.sent = std::lround(after(line, "total ") + after(line, "lost "));
    reference.lost = std::lround(after(line, "lost "));
  }
  return reference;
}

}  // namespace s4tp::benchmark
