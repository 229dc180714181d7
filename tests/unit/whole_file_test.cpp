// What is read at once: an ordinary file that is not too large, and nothing that may have no end.
#include "sim_host/world/scenario/whole_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>

#include "sim_host/campaign/episode_record.hpp"
#include "sim_host/campaign/weights_file.hpp"
#include "sim_host/recording/drive_note.hpp"
#include "tests/support/networks.hpp"

namespace s4tp::scenario {
namespace {

std::string why_not_read(const std::function<void()>& read) {
  try {
    read();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

// FILE-012 As many bytes as may be are read as they are; one more, a device, a folder, nothing: each is told.
TEST(WholeFile, IsOrdinaryAndNotTooLong) {
  const test::Folder folder;
  const std::string bytes("a\0\r\n", 4);
  const auto file = folder.write("file", bytes);
  EXPECT_EQ(whole_file(file, 4), bytes);
  const auto why = [](const std::filesystem::path& path) {
    return why_not_read([&] { (void)whole_file(path, 3); });
  };
  EXPECT_EQ(why(file), file.string() + ": longer than 3 bytes");
  EXPECT_EQ(why("/dev/null"), "/dev/null: is no ordinary file");
  EXPECT_EQ(why(folder.path()), folder.path().string() + ": is no ordinary file");
  EXPECT_EQ(why(folder.path() / "none"), (folder.path() / "none").string() + ": there is no such file");
}

// FILE-012 A campaign's record, a weight image and a recording's note that lead to a device are refused.
TEST(WholeFile, ReadersTakeNoDevice) {
  const test::Folder folder;
  std::filesystem::create_directory(folder.path() / "drive.log.drive");
  std::filesystem::create_symlink("/dev/null", folder.path() / "drive.log.drive" / "drive.json");
  EXPECT_NE(why_not_read([] { (void)campaign::read_part("/dev/null"); }), "");
  EXPECT_NE(why_not_read([] { (void)campaign::bank_with("/dev/null"); }), "");
  const std::string note = why_not_read([&] { (void)recording::read_note(folder.path() / "drive.log"); });
  EXPECT_NE(note.find("ordinary file"), std::string::npos) << note;
}

}  // namespace
}  // namespace s4tp::scenario
