// Keys of authentication: where they come from, and that mbedTLS computes what RFC 4493 says.
#include "hal/linux/key_file.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "hal/linux/mbedtls_authenticator.hpp"

namespace s4tp::hal::linux_host {
namespace {

namespace fs = std::filesystem;

constexpr const char* kGood = "000102030405060708090a0b0c0d0eff";

struct KeyFile : testing::Test {
  KeyFile() { fs::create_directories(folder); }
  ~KeyFile() override { fs::remove_all(folder); }

  std::string file(const std::string& text, mode_t mode = 0600) {
    const fs::path path = folder / "key";
    fs::remove(path);
    std::ofstream(path) << text;
    EXPECT_EQ(chmod(path.c_str(), mode), 0);
    return path;
  }
  /// Why it is refused; empty: it is not.
  std::string refusal(const std::string& place) {
    Reason reason;
    return read_key(place.c_str(), key, reason) ? "" : reason.text;
  }

  fs::path folder = fs::temp_directory_path() / ("s4tp_key_" + std::to_string(getpid()));
  AuthenticationKey key;
};

// AUTH-030 A file or a variable with 32 hexadecimal digits, white space around them or not.
TEST_F(KeyFile, IsRead) {
  for (const std::string& text : {std::string(kGood), std::string(" \n") + kGood + "\r\n"}) {
    key = {};
    EXPECT_EQ(refusal(file(text)), "");
    EXPECT_EQ(key.bytes[1], 1);
    EXPECT_EQ(key.bytes[15], 0xFF);
  }
  ASSERT_EQ(setenv("S4TP_TEST_KEY", kGood, 1), 0);
  key = {};
  EXPECT_EQ(refusal("env:S4TP_TEST_KEY"), "");
  EXPECT_EQ(key.bytes[15], 0xFF);
  EXPECT_EQ(unsetenv("S4TP_TEST_KEY"), 0);
}

// AUTH-031 What is missing, open to others, too short, too long, not hexadecimal, or zero is refused with a
// reason that names the place, and the key that was there before stays.
TEST_F(KeyFile, IsRefusedWithAReason) {
  const auto contains = [](const std::string& text, const std::string& word) {
    return text.find(word) != std::string::npos;
  };
  key.bytes[0] = 77;
  EXPECT_TRUE(contains(refusal((folder / "none").string()), "No such file"));
  EXPECT_TRUE(contains(refusal("env:S4TP_NO_SUCH_KEY"), "no such environment variable"));
  for (const mode_t mode : {0640, 0604, 0660, 0602}) {
    EXPECT_TRUE(contains(refusal(file(kGood, mode)), "chmod 600")) << std::oct << mode;
  }
  EXPECT_TRUE(contains(refusal(folder.string()), "no ordinary file"));
  EXPECT_TRUE(contains(refusal(file("00112233")), "too short: 8 of 32"));
  EXPECT_TRUE(contains(refusal(file("")), "too short: 0 of 32"));
  EXPECT_TRUE(contains(refusal(file(std::string(kGood) + "0")), "too long"));
  EXPECT_TRUE(contains(refusal(file(std::string(1000, ' '))), "too long"));
  EXPECT_TRUE(contains(refusal(file("000102030405060708090a0b0c0d0efg")), "hexadecimal"));
  EXPECT_TRUE(contains(refusal(file(std::string(kGood) + " 1")), "more than one word"));
  EXPECT_TRUE(contains(refusal(file(std::string(32, '0'))), "all zeros"));
  EXPECT_TRUE(contains(refusal(file(kGood + std::string(1, '\0') + "more")), "hexadecimal"));
  EXPECT_FALSE(contains(refusal(file(std::string(kGood) + "0")), "0102"));
  EXPECT_EQ(key.bytes[0], 77);
}

// AUTH-003 RFC 4493, section 4: the four messages.
TEST(Cmac, IsThatOfTheRfc) {
  const AuthenticationKey key{
      {0x2b, 0x7e, 0x15, 0x16, 0x28, 0xae, 0xd2, 0xa6, 0xab, 0xf7, 0x15, 0x88, 0x09, 0xcf, 0x4f, 0x3c}};
  const std::uint8_t message[64] = {
      0x6b, 0xc1, 0xbe, 0xe2, 0x2e, 0x40, 0x9f, 0x96, 0xe9, 0x3d, 0x7e, 0x11, 0x73, 0x93, 0x17, 0x2a,
      0xae, 0x2d, 0x8a, 0x57, 0x1e, 0x03, 0xac, 0x9c, 0x9e, 0xb7, 0x6f, 0xac, 0x45, 0xaf, 0x8e, 0x51,
      0x30, 0xc8, 0x1c, 0x46, 0xa3, 0x5c, 0xe4, 0x11, 0xe5, 0xfb, 0xc1, 0x19, 0x1a, 0x0a, 0x52, 0xef,
      0xf6, 0x9f, 0x24, 0x45, 0xdf, 0x4f, 0x9b, 0x17, 0xad, 0x2b, 0x41, 0x7b, 0xe6, 0x6c, 0x37, 0x10};
  struct Case {
    std::uint32_t size;
    std::uint8_t mac[4];
  };
  MbedtlsAuthenticator keys(key);
  for (const Case& one : {Case{0, {0xbb, 0x1d, 0x69, 0x29}}, Case{16, {0x07, 0x0a, 0x16, 0xb4}},
                          Case{40, {0xdf, 0xa6, 0x67, 0x47}}, Case{64, {0x51, 0xf0, 0xbe, 0xbf}}}) {
    std::uint8_t mac[kCmacBytes];
    ASSERT_TRUE(keys.cmac(KeySlot::kLongTerm, message, one.size, mac));
    for (int i = 0; i < 4; ++i) EXPECT_EQ(mac[i], one.mac[i]) << one.size;
  }
}

// AUTH-010 A slot without a key authenticates nothing; the long-term key is not overwritten.
TEST(Cmac, SlotsAreEmptyUntilDerived) {
  MbedtlsAuthenticator keys(AuthenticationKey{{1}});
  const std::uint8_t text[] = {1, 2, 3};
  std::uint8_t mac[kCmacBytes];
  EXPECT_FALSE(keys.cmac(KeySlot::kSession, text, sizeof text, mac));
  EXPECT_TRUE(keys.derive(KeySlot::kSession, text, sizeof text));
  EXPECT_TRUE(keys.cmac(KeySlot::kSession, text, sizeof text, mac));
  EXPECT_FALSE(keys.cmac(KeySlot::kCandidate, text, sizeof text, mac));
  std::uint8_t random[2][8];
  EXPECT_TRUE(keys.random(random[0], 8) && keys.random(random[1], 8));
  EXPECT_NE(std::string(reinterpret_cast<char*>(random[0]), 8),
            std::string(reinterpret_cast<char*>(random[1]), 8));
}

}  // namespace
}  // namespace s4tp::hal::linux_host
