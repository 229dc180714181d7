#pragma once
/// The frames of a log in candump's format, ours or candump's own.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "firmware/wire/candump.hpp"

namespace s4tp::test {

/// Lines that are no classic data frame with 11 bits of id are left out.
inline std::vector<wire::Frame> frames_of_log(const std::filesystem::path& log) {
  std::vector<wire::Frame> frames;
  std::ifstream stream(log);
  EXPECT_TRUE(stream.good()) << log;
  for (std::string line; std::getline(stream, line);) {
    wire::LoggedFrame logged;
    if (wire::parse_candump(line.data(), static_cast<int>(line.size()), logged) ==
        wire::CandumpResult::kFrame) {
      frames.push_back(logged.frame);
    }
  }
  return frames;
}

}  // namespace s4tp::test
