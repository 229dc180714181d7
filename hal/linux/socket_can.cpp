#include "hal/linux/socket_can.hpp"

namespace s4tp::hal::linux_host {
namespace {

constexpr std::uint32_t kLargestId = 0x7FF;
constexpr int kReportsPerReceive = 64;  // error frames read over in one call
constexpr int kRetryMs = 1;             // a driver's queue has no event for "room again"

LinkNews news_of(LinkState link) {
  switch (link) {
    case LinkState::kUp:
      return LinkNews::kBack;
    case LinkState::kDown:
      return LinkNews::kDown;
    case LinkState::kRenamed:
      return LinkNews::kRenamed;
    default:
      return LinkNews::kGone;
  }
}

}  // namespace

bool is_can_length(std::uint8_t length) {
  if (length <= 8) return true;
  if (length <= 24) return length % 4 == 0;
  return length == 32 || length == 48 || length == 64;
}

bool SocketCan::open(Reason& reason) {
  open_ = socket_.open(reason);
  link_ = open_ ? LinkState::kUp : LinkState::kGone;
  state_ = open_ ? CanState::kActive : CanState::kDown;
  looked_ms_ = socket_.now_ms();
  return open_;
}

bool SocketCan::receive(CanFrame& frame) {
  flush();
  for (int i = 0; open_ && i < kReportsPerReceive; ++i) {
    Reading reading;
    const ReadResult result = socket_.read(reading);
    counters_.dropped += reading.lost;
    switch (result) {
      case ReadResult::kFrame:
        ++counters_.received;
        received_at_us_ = reading.time_us;
        if (state_ == CanState::kBusOff && !reading.local) set_state(CanState::kActive, LinkNews::kActive);
        frame = reading.frame;
        return true;
      case ReadResult::kReport:
        take_report(reading.report);
        break;
      case ReadResult::kForeign:
        break;
      case ReadResult::kNothing:
        return false;
      case ReadResult::kFailed:
        look_now_ = true;
        look_after_link();
        return false;
    }
  }
  return false;
}

bool SocketCan::send(const CanFrame& frame) {
  const bool possible = frame.id <= kLargestId && is_can_length(frame.length);
  if (size_ == kQueueFrames) flush();
  if (!possible || !usable() || size_ == kQueueFrames) {
    ++counters_.dropped;
    return false;
  }
  queue_[(first_ + size_++) % kQueueFrames] = frame;
  flush();
  return true;
}

void SocketCan::flush() {
  for (int i = 0; i < kQueueFrames && size_ > 0 && usable(); ++i) {
    const WriteResult result = socket_.write(queue_[first_]);
    if (result == WriteResult::kFull) return;
    if (result == WriteResult::kFailed) {
      look_now_ = true;
      look_after_link();
      return;
    }
    first_ = (first_ + 1) % kQueueFrames;
    --size_;
    if (result == WriteResult::kSent) {
      ++counters_.sent;
    } else {
      ++counters_.dropped;
      ++counters_.errors;
    }
  }
}

bool SocketCan::wait(int timeout_ms) {
  const std::uint64_t end_ms = socket_.now_ms() + static_cast<std::uint64_t>(timeout_ms < 0 ? 0 : timeout_ms);
  for (int i = 0; i <= timeout_ms; ++i) {  // each turn but the last takes 1 ms or more
    look_after_link();
    flush();
    const std::uint64_t now_ms = socket_.now_ms();
    const std::uint64_t left_ms = end_ms > now_ms ? end_ms - now_ms : 0;
    std::uint64_t slice_ms = size_ > 0 ? kRetryMs : kLookMs;
    if (left_ms < slice_ms) slice_ms = left_ms;
    if (socket_.wait(static_cast<int>(slice_ms))) return true;
    if (left_ms == slice_ms) return false;
  }
  return false;
}

void SocketCan::look_after_link() {
  const std::uint64_t now_ms = socket_.now_ms();
  if (restart_.due(now_ms)) {
    if (socket_.restart()) {
      news_.post(LinkNews::kRestartAsked);
    } else if (!restart_refused_) {
      restart_refused_ = true;
      news_.post(LinkNews::kRestartRefused);
    }
  }
  if (!look_now_ && now_ms < looked_ms_ + kLookMs) return;
  look_now_ = false;
  looked_ms_ = now_ms;
  if (!open_) {
    Reason reason;
    open_ = socket_.open(reason);
    if (!open_) return;
  }
  const LinkState link = socket_.look();
  if (link != link_) take_link(link);
  if (link == LinkState::kUp || link == LinkState::kDown) return;
  socket_.close();
  open_ = false;
}

void SocketCan::take_link(LinkState link) {
  link_ = link;
  drop_queue();
  set_state(link == LinkState::kUp ? CanState::kActive : CanState::kDown, news_of(link));
}

void SocketCan::drop_queue() {
  counters_.dropped += static_cast<std::uint32_t>(size_);
  size_ = 0;
}

void SocketCan::take_report(const ControllerReport& report) {
  ++counters_.errors;
  if (report.overflow) ++counters_.dropped;
  if (report.bus_off && state_ != CanState::kBusOff) {
    drop_queue();
    set_state(CanState::kBusOff, LinkNews::kBusOff);
    restart_.begin(socket_.now_ms());
  } else if (report.passive && state_ == CanState::kActive) {
    set_state(CanState::kPassive, LinkNews::kPassive);
  } else if (report.active && (state_ == CanState::kPassive || state_ == CanState::kBusOff)) {
    set_state(CanState::kActive, LinkNews::kActive);
  }
}

void SocketCan::set_state(CanState state, LinkNews news) {
  state_ = state;
  restart_.end();
  restart_refused_ = false;
  news_.post(news);
}

}  // namespace s4tp::hal::linux_host
