#include "hal/linux/slcan_can.hpp"

#include <time.h>

namespace s4tp::hal::linux_host {
namespace {

constexpr int kFullLinkWaitMs = 1;
constexpr char kOpenAdapter[] = "C\rS6\rO\r";

std::uint64_t clock_us(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<std::uint64_t>(now.tv_sec) * 1'000'000U +
         static_cast<std::uint64_t>(now.tv_nsec) / 1000U;
}

std::uint64_t now_ms() {
  return clock_us(CLOCK_MONOTONIC) / 1000U;
}

}  // namespace

void SlcanCan::filter(const std::uint32_t* ids, int count) {
  for (std::uint64_t& word : wanted_) word = count == 0 ? ~std::uint64_t{0} : 0;
  for (int i = 0; i < count; ++i) wanted_[ids[i] % 2048 / 64] |= std::uint64_t{1} << (ids[i] % 64);
}

bool SlcanCan::receive(CanFrame& frame) {
  flush();
  for (int i = 0; i <= static_cast<int>(sizeof in_); ++i) {
    if (in_next_ == in_size_) {
      in_next_ = 0;
      in_size_ = link_.read(in_, sizeof in_);
      if (in_size_ == 0) {
        if (!link_.connected()) look_after_link();
        return false;
      }
    }
    CanFrame read;
    const SlcanEvent event = parser_.take(in_[in_next_++], read);
    if (event == SlcanEvent::kFrame && wanted(read.id)) {
      frame = read;
      ++counters_.received;
      received_at_us_ = clock_us(CLOCK_REALTIME);
      return true;
    }
    if (event == SlcanEvent::kGarbage || event == SlcanEvent::kRefused) ++counters_.errors;
  }
  return false;
}

bool SlcanCan::send(const CanFrame& frame) {
  char line[kSlcanLineSize];
  const int size = format_slcan(frame, line);
  if (state_ == CanState::kDown) look_after_link();
  if (size == 0 || state_ == CanState::kDown || out_size_ + size > kQueueBytes) {
    ++counters_.dropped;
    return false;
  }
  put(line, size);
  ++out_frames_;
  flush();
  return true;
}

void SlcanCan::put(const char* text, int size) {
  for (int i = 0; i < size; ++i) out_[(out_first_ + out_size_ + i) % kQueueBytes] = text[i];
  out_size_ += size;
}

void SlcanCan::flush() {
  for (int i = 0; i < 2 && out_size_ > 0; ++i) {  // up to the end of the ring, and from its beginning
    const int straight = kQueueBytes - out_first_;
    const int taken = link_.write(out_ + out_first_, out_size_ < straight ? out_size_ : straight);
    out_first_ = (out_first_ + taken) % kQueueBytes;
    out_size_ -= taken;
  }
  if (out_size_ > 0) return;
  counters_.sent += static_cast<std::uint32_t>(out_frames_);
  out_frames_ = 0;
}

bool SlcanCan::wait(int timeout_ms) {
  const std::uint64_t end_ms = now_ms() + static_cast<std::uint64_t>(timeout_ms < 0 ? 0 : timeout_ms);
  for (int i = 0; i <= timeout_ms; ++i) {  // each turn but the last takes 1 ms or more
    if (in_next_ < in_size_) return true;
    look_after_link();
    flush();
    const std::uint64_t now = now_ms();
    const std::uint64_t left_ms = end_ms > now ? end_ms - now : 0;
    std::uint64_t slice_ms = out_size_ > 0 ? kFullLinkWaitMs : kRetryMs;
    if (left_ms < slice_ms) slice_ms = left_ms;
    if (link_.wait(static_cast<int>(slice_ms)) && link_.connect()) return true;
    if (left_ms == slice_ms) return false;
  }
  return false;
}

void SlcanCan::look_after_link() {
  if (state_ != CanState::kDown && !link_.connected()) {
    state_ = CanState::kDown;
    news_.post(LinkNews::kGone);
    counters_.dropped += static_cast<std::uint32_t>(out_frames_);
    out_size_ = out_frames_ = in_next_ = in_size_ = 0;
    parser_ = SlcanParser();
  }
  if (state_ != CanState::kDown) return;
  const std::uint64_t now = now_ms();
  if (!link_.connected() && now < tried_ms_ + kRetryMs) return;
  tried_ms_ = now;
  if (!link_.connect()) return;
  state_ = CanState::kActive;
  if (seen_) news_.post(LinkNews::kBack);
  seen_ = true;
  put(kOpenAdapter, sizeof kOpenAdapter - 1);
}

}  // namespace s4tp::hal::linux_host
