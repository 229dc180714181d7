// A log of the bus, read while it is written.
#include "sim_host/processes/log_follower.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "firmware/wire/candump.hpp"
#include "firmware/wire/codec.hpp"

namespace s4tp::processes {
namespace {

std::string line_of(std::uint32_t id, std::uint8_t value) {
  wire::Frame frame;
  frame.id = static_cast<std::uint16_t>(id);
  frame.length = 2;
  frame.data[1] = value;
  char line[wire::kCandumpLineSize];
  wire::format_candump({10'000, "vcan0", frame}, line);
  return std::string(line) + '\n';
}

// TELE-008 Written byte by byte, a tick of the world comes as a whole and the ECU's frames one by one, each when its
// line has an end; comments and lines that are no frame are passed over. Before there is a file, nothing comes.
TEST(LogFollower, TellsTicksAsTheyAreWritten) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("s4tp_follow_" + std::to_string(getpid()) + ".log");
  std::filesystem::remove(file);
  LogFollower follower(file);
  std::vector<std::vector<std::uint32_t>> told;
  std::vector<std::size_t> told_at;
  std::size_t written = 0;
  const auto keep = [&](const std::vector<wire::Frame>& frames) {
    told.emplace_back();
    for (const wire::Frame& frame : frames) told.back().push_back(frame.id);
    told_at.push_back(written);
  };
  EXPECT_FALSE(follower.look(keep));

  const std::string tick = line_of(wire::kMotionId, 1) + "no frame\n" + line_of(wire::kTickId, 2);
  const std::string text = "# s4tp log: seed 3\n" + tick + line_of(wire::kCommandId, 3) +
                           line_of(wire::kVersionEcuId, 4) + line_of(wire::kTickId, 5);
  std::ofstream log(file);
  for (const char byte : text) {
    log << byte << std::flush;
    ++written;
    EXPECT_TRUE(follower.look(keep));
    EXPECT_FALSE(follower.look(keep)) << "there is nothing new";
  }
  const std::vector<std::vector<std::uint32_t>> wanted = {
      {wire::kMotionId, wire::kTickId}, {wire::kCommandId}, {wire::kVersionEcuId}, {wire::kTickId}};
  EXPECT_EQ(told, wanted);
  ASSERT_EQ(told_at.size(), 4U);
  EXPECT_EQ(told_at[0], text.find(line_of(wire::kCommandId, 3)));
  EXPECT_EQ(told_at[3], text.size());
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace s4tp::processes
