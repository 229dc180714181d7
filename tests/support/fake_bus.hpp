#pragma once
/// A bus for one end, in memory: a test puts frames in, sees what is sent, and may answer it.

#include <deque>
#include <functional>
#include <thread>
#include <vector>

#include "hal/linux/linux_can.hpp"

namespace s4tp::hal::linux_host {

inline CanFrame frame_of(std::uint32_t id, std::uint8_t length = 8) {
  CanFrame frame;
  frame.id = id;
  frame.length = length;
  return frame;
}

class FakeBus final : public LinuxCan {
 public:
  bool receive(CanFrame& frame) override {
    if (incoming.empty()) return false;
    frame = incoming.front();
    if (!endless) incoming.pop_front();
    ++counters_.received;
    return true;
  }
  bool send(const CanFrame& frame) override {
    if (link != CanState::kActive) return false;
    sent.push_back(frame);
    ++counters_.sent;
    if (on_send) on_send(frame);
    return true;
  }
  CanState state() const override { return link; }
  CanCounters counters() const override { return counters_; }
  bool wait(int timeout_ms) override {
    if (on_wait) on_wait();
    if (incoming.empty()) std::this_thread::sleep_for(std::chrono::milliseconds(timeout_ms));
    return !incoming.empty();
  }
  std::uint64_t received_at_us() const override { return 0; }
  bool take_news(LinkNews& one) override { return news.take(one); }

  std::deque<CanFrame> incoming;
  bool endless = false;  ///< the first frame comes again and again
  std::vector<CanFrame> sent;
  std::function<void(const CanFrame&)> on_send;
  std::function<void()> on_wait;
  CanState link = CanState::kActive;
  NewsBoard news;

 private:
  CanCounters counters_;
};

}  // namespace s4tp::hal::linux_host
