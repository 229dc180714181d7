#include "sim_host/world/scenario/utf8.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "sim_host/campaign/parameters_file.hpp"
#include "sim_host/world/scenario/scenario.hpp"
#include "tests/support/networks.hpp"

namespace s4tp::scenario {
namespace {

// RFC 3629, section 3 and its table: the first and last of each length; then overlong forms, surrogates,
// above U+10FFFF, a byte missing, a byte alone.
TEST(Utf8, IsOrIsNot) {
  for (const std::string good : {"", "straße", "\x7F", "\xC2\x80", "\xDF\xBF", "\xE0\xA0\x80", "\xED\x9F\xBF",
                                 "\xEE\x80\x80", "\xEF\xBF\xBF", "\xF0\x90\x80\x80", "\xF4\x8F\xBF\xBF"}) {
    EXPECT_TRUE(is_utf8(good)) << good;
  }
  for (const std::string bad : {"\x80", "\xC1\xBF", "\xE0\x9F\xBF", "\xED\xA0\x80", "\xF0\x8F\xBF\xBF",
                                "\xF4\x90\x80\x80", "\xF8\x88\x80\x80\x80", "\xE2\x82", "a\xFF", "\xC3(",
                                "stra\xDF"
                                "e"}) {
    EXPECT_FALSE(is_utf8(bad)) << bad;
  }
}

// FILE-007 A folder named in Latin-1 failed after the drive, when its name was to go into the result: it
// fails before, by name; also when only the folder we stand in is called so, and for a file of parameters.
TEST(Utf8, NamesOfFilesAreUtf8) {
  namespace fs = std::filesystem;
  const test::Folder folder;
  const fs::path odd = folder.path() /
                       "stra\xDF"
                       "e";
  fs::create_directory(odd);
  std::ofstream(odd / "scenario.toml") << "";
  std::ofstream(odd / "p.toml") << "";
  const fs::path before = fs::current_path();
  const auto error_of = [](const auto& call) {
    try {
      call();
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_NE(error_of([&] { (void)load_scenario(odd); }).find("stra?e: this name is not UTF-8"),
            std::string::npos);
  EXPECT_NE(error_of([&] { (void)campaign::load_parameters(odd / "p.toml"); }).find("not UTF-8"),
            std::string::npos);
  fs::current_path(odd);
  const std::string here = error_of([&] { (void)load_scenario("."); });
  fs::current_path(before);
  EXPECT_NE(here.find("stra?e: this name is not UTF-8"), std::string::npos) << here;
}

}  // namespace
}  // namespace s4tp::scenario
