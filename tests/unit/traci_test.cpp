#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <thread>

#include "sim_host/sumo/traci_client.hpp"

namespace s4tp::sumo::traci {
namespace {

using Bytes = std::vector<std::uint8_t>;
using namespace std::chrono_literals;

// TRACI-001 A step to the next step: 4 bytes of length (14), command length 10, command 0x02, a double of 0.
TEST(Traci, FramesAStep) {
  EXPECT_EQ(message(0x02, Writer().real(0.0)), (Bytes{0, 0, 0, 14, 10, 0x02, 0, 0, 0, 0, 0, 0, 0, 0}));
}

// TRACI-001 Set (0xc4) speed mode (0xb3) of "ego" to the integer 0 (type 0x09): 1 + 1 + 1 + 4 + 3 + 5 = 15
// bytes.
TEST(Traci, FramesASet) {
  const Writer content = Writer().byte(kSpeedMode).text("ego").typed_integer(0);
  EXPECT_EQ(message(0xC4, content),
            (Bytes{0, 0, 0, 19, 15, 0xC4, 0xB3, 0, 0, 0, 3, 'e', 'g', 'o', 0x09, 0, 0, 0, 0}));
}

// moveToXY: a compound of 6; 1.5 is 0x3FF8 0000 0000 0000, -1 as an integer 0xFFFFFFFF.
TEST(Traci, WritesTypedValues) {
  Writer value;
  value.compound(6).typed_text("").typed_integer(-1).typed_real(1.5).typed_byte(2).typed_texts({"a"});
  EXPECT_EQ(value.bytes(),
            (Bytes{0x0F, 0, 0, 0, 6, 0x0C, 0,    0, 0,    0, 0x09, 0xFF, 0xFF, 0xFF, 0xFF, 0x0B, 0x3F, 0xF8,
                   0,    0, 0, 0, 0, 0,    0x08, 2, 0x0E, 0, 0,    0,    1,    0,    0,    0,    1,    'a'}));
}

// TRACI-001 Beyond 255 bytes the one byte of length is 0 and four bytes follow, which count themselves.
TEST(Traci, FramesALongCommand) {
  const Bytes bytes = message(0x00, Writer().text(std::string(300, 'x')));
  ASSERT_EQ(bytes.size(), 4U + 1U + 4U + 1U + 304U);
  EXPECT_EQ(Bytes(bytes.begin(), bytes.begin() + 10), (Bytes{0, 0, 1, 0x3A, 0, 0, 0, 1, 0x36, 0x00}));
  Reader reader(std::span<const std::uint8_t>(bytes).subspan(4));
  Reader command = reader.command();
  EXPECT_EQ(command.byte(), 0x00);
  EXPECT_EQ(command.text(), std::string(300, 'x'));
  EXPECT_TRUE(reader.at_end() && command.at_end());
}

// Every type that SUMO's answers of ours hold; a byte 0xFE is -2 signed and 254 unsigned.
TEST(Traci, ReadsTypedValues) {
  Writer text;
  text.typed_integer(-7).typed_real(2.5).typed_text("lane").typed_texts({"a", "bc"}).typed_byte(0xFE);
  text.byte(0x07).byte(0xFE).byte(0x01).real(3.0).real(-4.0);
  Reader reader(text.bytes());
  EXPECT_EQ(std::get<int>(reader.typed()), -7);
  EXPECT_EQ(std::get<double>(reader.typed()), 2.5);
  EXPECT_EQ(std::get<std::string>(reader.typed()), "lane");
  EXPECT_EQ(std::get<std::vector<std::string>>(reader.typed()), (std::vector<std::string>{"a", "bc"}));
  EXPECT_EQ(std::get<int>(reader.typed()), -2);
  EXPECT_EQ(std::get<int>(reader.typed()), 254);
  const map::Vec2 point = std::get<map::Vec2>(reader.typed());
  EXPECT_EQ(point.x, 3.0);
  EXPECT_EQ(point.y, -4.0);
  EXPECT_TRUE(reader.at_end());
}

// What ends early, claims a negative length or holds an unknown type is refused.
TEST(Traci, RefusesBrokenBytes) {
  const auto typed = [](Bytes bytes) { return Reader(bytes).typed(); };
  EXPECT_THROW((void)typed({0x09, 0, 0}), Error);
  EXPECT_THROW((void)typed({0x0C, 0xFF, 0xFF, 0xFF, 0xFF}), Error);
  EXPECT_THROW((void)typed({0x0C, 0x7F, 0xFF, 0xFF, 0xFF, 'a'}), Error);
  EXPECT_THROW((void)typed({0x42}), Error);
  const Bytes no_length{0, 0, 0, 0, 2};
  EXPECT_THROW((void)Reader(no_length).command(), Error);
}

/// A SUMO that takes one command and answers with the bytes given, then hangs up (or stays silent).
class Scripted {
 public:
  explicit Scripted(Bytes answer, bool hang_up = true) {
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0) throw std::runtime_error("socketpair");
    client = std::make_unique<Client>(ends[0], 50ms);
    far_end_ = ends[1];
    (void)!write(far_end_, answer.data(), answer.size());
    if (hang_up) shutdown(far_end_, SHUT_WR);
  }
  ~Scripted() { close(far_end_); }
  std::unique_ptr<Client> client;

 private:
  int far_end_;
};

Bytes whole(const Bytes& content) {
  Bytes bytes = Writer().integer(static_cast<int>(content.size()) + 4).bytes();
  bytes.insert(bytes.end(), content.begin(), content.end());
  return bytes;
}

// TRACI-002 A refusal carries SUMO's own words.
TEST(TraciClient, SaysWhatSumoSays) {
  Scripted sumo(whole({14, 0xC4, 0xFF, 0, 0, 0, 7, 'n', 'o', ' ', 's', 'u', 'c', 'h'}));
  try {
    sumo.client->set(Domain::kVehicle, kSpeedMode, "ego", Writer().typed_integer(0));
    FAIL() << "taken";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("no such"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("ego"), std::string::npos);
  }
}

// TRACI-002 Nobody waits for ever: hung up before and within an answer, silence, an answer of 2 GB.
TEST(TraciClient, NeverHangs) {
  for (const Bytes& answer :
       {Bytes{}, Bytes{0, 0}, Bytes{0, 0, 0, 99, 1, 2, 3}, Bytes{0x7F, 0xFF, 0xFF, 0xFF}}) {
    EXPECT_THROW((void)Scripted(answer).client->step(), Error);
    EXPECT_THROW((void)Scripted(answer, false).client->step(), Error);
  }
}

// A step's answer: status, one event of the vehicle "a" with speed 2.5.
TEST(TraciClient, ReadsAStep) {
  Writer event;
  event.byte(0xE4).text("a").byte(1).byte(kSpeed).byte(0).typed_real(2.5);
  Bytes content{7, 0x02, 0, 0, 0, 0, 0, 0, 0, 0, 1, static_cast<std::uint8_t>(event.bytes().size() + 1)};
  content.insert(content.end(), event.bytes().begin(), event.bytes().end());
  const auto seen = Scripted(whole(content)).client->step();
  EXPECT_EQ(std::get<double>(seen.at(Domain::kVehicle).at("a").at(kSpeed)), 2.5);
}

// TRACI-002 Whatever bytes come: a value or an Error, nothing else and no crash.
TEST(TraciClient, SurvivesAnyAnswer) {
  EXPECT_TRUE(rc::check([](const Bytes& noise, bool framed) {
    Bytes content{7, 0x02, 0, 0, 0, 0, 0};
    content.insert(content.end(), noise.begin(), noise.end());
    try {
      (void)Scripted(framed ? whole(content) : noise).client->step();
    } catch (const Error&) {
    }
  }));
}

}  // namespace
}  // namespace s4tp::sumo::traci
