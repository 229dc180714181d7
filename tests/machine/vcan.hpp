#pragma once
/// A vcan0 of the test's own, an end of the bus on it, and a program that sends anything.

#include <gtest/gtest.h>
#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "hal/linux/can_socket.hpp"
#include "hal/linux/named_bus.hpp"

namespace s4tp::hal::linux_host {

inline void shell(const std::string& command) {
  ASSERT_EQ(std::system(command.c_str()), 0) << command;
}

/// A plain socket that sends anything.
struct Attacker {
  int descriptor = socket(PF_CAN, SOCK_RAW, CAN_RAW);
  Attacker() {
    ifreq request{};
    std::snprintf(request.ifr_name, sizeof request.ifr_name, "vcan0");
    EXPECT_EQ(ioctl(descriptor, SIOCGIFINDEX, &request), 0);
    sockaddr_can address{};
    address.can_family = AF_CAN;
    address.can_ifindex = request.ifr_ifindex;
    EXPECT_EQ(bind(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  }
  ~Attacker() { close(descriptor); }
  void send(canid_t id, const std::vector<std::uint8_t>& data = std::vector<std::uint8_t>(8)) const {
    can_frame frame{};
    frame.can_id = id;
    frame.len = static_cast<std::uint8_t>(data.size());
    for (std::size_t i = 0; i < data.size(); ++i) frame.data[i] = data[i];
    ASSERT_EQ(write(descriptor, &frame, sizeof frame), static_cast<ssize_t>(sizeof frame));
  }
};

inline CanFrame frame_of(std::uint32_t id, std::uint8_t length = 8) {
  CanFrame frame;
  frame.id = id;
  frame.length = length;
  for (int i = 0; i < length; ++i) frame.data[i] = static_cast<std::uint8_t>(i);
  return frame;
}

class Vcan : public testing::Test {
 protected:
  void SetUp() override {
    (void)std::system("ip link del vcan0 2>/dev/null; ip link del bus7 2>/dev/null");
    shell("ip link add vcan0 type vcan && ip link set vcan0 mtu 72 up");
  }

  struct End {
    NamedBus bus;
    explicit End(const CanSocketOptions& options = {}) {
      Reason reason;
      EXPECT_TRUE(bus.open("vcan0", options, reason)) << reason.text;
    }
    LinuxCan& can() { return bus.can(); }
    /// Everything that comes until nothing has come for `quiet_ms`.
    std::vector<std::uint32_t> ids(int quiet_ms = 50) {
      std::vector<std::uint32_t> all;
      CanFrame frame;
      do {
        while (can().receive(frame)) all.push_back(frame.id);
      } while (can().wait(quiet_ms));
      return all;
    }
    /// Lets the bus run until its state is `wanted`, for 2 s at most.
    bool until(CanState wanted) {
      CanFrame frame;
      for (int i = 0; i < 100 && can().state() != wanted; ++i) {
        (void)can().wait(20);
        while (can().receive(frame)) {
        }
      }
      return can().state() == wanted;
    }
    std::vector<LinkNews> news() {
      std::vector<LinkNews> all;
      for (LinkNews one{}; can().take_news(one);) all.push_back(one);
      return all;
    }
  };
};

}  // namespace s4tp::hal::linux_host
