#pragma once
/// Two ends of a bus in memory, each on a thread of its own.

#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>

#include "hal/linux/linux_can.hpp"

namespace s4tp::hal::linux_host {

class BusPair {
 public:
  class End final : public LinuxCan {
   public:
    bool receive(CanFrame& frame) override {
      const std::lock_guard lock(pair_.mutex_);
      if (incoming_.empty()) return false;
      frame = incoming_.front().frame;
      received_at_us_ = incoming_.front().at_us;
      incoming_.pop_front();
      ++counters_.received;
      return true;
    }
    bool send(const CanFrame& frame) override {
      const std::lock_guard lock(pair_.mutex_);
      const auto now = std::chrono::system_clock::now().time_since_epoch();
      const auto us = std::chrono::duration_cast<std::chrono::microseconds>(now).count();
      other().incoming_.push_back({frame, static_cast<std::uint64_t>(us)});
      ++counters_.sent;
      other().arrived_.notify_one();
      return true;
    }
    bool wait(int timeout_ms) override {
      std::unique_lock lock(pair_.mutex_);
      return arrived_.wait_until(lock,
                                 std::chrono::system_clock::now() + std::chrono::milliseconds(timeout_ms),
                                 [this] { return !incoming_.empty(); });
    }
    CanState state() const override { return CanState::kActive; }
    CanCounters counters() const override { return counters_; }
    std::uint64_t received_at_us() const override { return received_at_us_; }
    bool take_news(LinkNews&) override { return false; }

   private:
    friend class BusPair;
    explicit End(BusPair& pair) : pair_(pair) {}
    End& other() { return this == &pair_.world ? pair_.ecu : pair_.world; }
    struct Arrival {
      CanFrame frame;
      std::uint64_t at_us;
    };
    BusPair& pair_;
    std::deque<Arrival> incoming_;
    std::condition_variable arrived_;
    std::uint64_t received_at_us_ = 0;
    CanCounters counters_;
  };

  End world{*this};
  End ecu{*this};

 private:
  std::mutex mutex_;
};

}  // namespace s4tp::hal::linux_host
