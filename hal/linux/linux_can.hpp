#pragma once
/// What a bus on Linux offers beside its frames: waiting, times of arrival, and news of the link.

#include <cstdint>

#include "hal/can.hpp"

namespace s4tp::hal::linux_host {

/// What happened to the link; each is told once.
enum class LinkNews : std::uint8_t {
  kNone = 0,
  kDown = 1,            ///< interface down
  kGone = 2,            ///< interface removed, or peer disconnected
  kRenamed = 3,         ///< interface has another name now: as good as gone, for a bus is what its name says
  kBack = 4,            ///< usable again after one of the above
  kPassive = 5,         ///< controller error-passive
  kBusOff = 6,          ///< controller bus-off
  kActive = 7,          ///< controller error-active again after one of the two above
  kRestartAsked = 8,    ///< the controller was told to leave bus-off
  kRestartRefused = 9,  ///< it could not be told: no right to, or no such function
};

/// In words, for a report.
[[nodiscard]] const char* link_news_text(LinkNews news);

class LinuxCan : public Can {
 public:
  /// Looks after the link and what is queued, and returns when there may be a frame to receive or
  /// `timeout_ms` have passed. \return false: time is up
  [[nodiscard]] virtual bool wait(int timeout_ms) = 0;
  /// When the frame last received arrived [us since 1970]: the kernel's time stamp, the time it was read
  /// where there is none.
  [[nodiscard]] virtual std::uint64_t received_at_us() const = 0;
  /// Oldest news not yet taken. \return false when there is none
  [[nodiscard]] virtual bool take_news(LinkNews& news) = 0;

 protected:
  ~LinuxCan() = default;
};

/// The last few news; the oldest makes way.
class NewsBoard {
 public:
  void post(LinkNews news) {
    if (size_ == kCapacity) {
      first_ = (first_ + 1) % kCapacity;
      --size_;
    }
    news_[(first_ + size_++) % kCapacity] = news;
  }
  [[nodiscard]] bool take(LinkNews& news) {
    if (size_ == 0) return false;
    news = news_[first_];
    first_ = (first_ + 1) % kCapacity;
    --size_;
    return true;
  }

 private:
  static constexpr int kCapacity = 16;
  LinkNews news_[kCapacity] = {};
  int first_ = 0;
  int size_ = 0;
};

/// Why a bus could not be opened, for the user.
struct Reason {
  char text[256] = {};
};

}  // namespace s4tp::hal::linux_host
