#pragma once
/// Frames that one companion authenticates together: a set, in ascending order of id and content, so that
/// neither a controller that sends by priority nor one that repeats a frame changes what the MAC is over.

#include <cstdint>

#include "firmware/secoc/message.hpp"
#include "firmware/wire/frame.hpp"
#include "firmware/wire/track_list.hpp"

namespace s4tp::secoc {

class FrameGroup {
 public:
  static constexpr int kMaxFrames = 1 + 2 * wire::kMaxTracks;

  [[nodiscard]] int size() const { return size_; }
  [[nodiscard]] const wire::Frame& at(int i) const { return frames_[i]; }
  void clear() { size_ = 0; }

  [[nodiscard]] bool has(const wire::Frame& frame) const {
    for (int i = 0; i < size_; ++i) {
      if (compare(frames_[i], frame) == 0) return true;
    }
    return false;
  }
  /// What is there already changes nothing. \return false: full
  [[nodiscard]] bool add(const wire::Frame& frame) {
    int place = size_;
    while (place > 0 && compare(frames_[place - 1], frame) > 0) --place;
    if (place > 0 && compare(frames_[place - 1], frame) == 0) return true;
    if (size_ == kMaxFrames) return false;
    for (int i = size_; i > place; --i) frames_[i] = frames_[i - 1];
    frames_[place] = frame;
    ++size_;
    return true;
  }
  void add_to(Message& message) const {
    for (int i = 0; i < size_; ++i) message.add(frames_[i]);
  }

 private:
  static int compare(const wire::Frame& a, const wire::Frame& b) {
    if (a.id != b.id) return a.id < b.id ? -1 : 1;
    for (int i = 0; i < 8; ++i) {
      if (a.data[i] != b.data[i]) return a.data[i] < b.data[i] ? -1 : 1;
    }
    return 0;
  }

  wire::Frame frames_[kMaxFrames];
  int size_ = 0;
};

}  // namespace s4tp::secoc
