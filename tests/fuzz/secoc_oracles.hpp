#pragma once
/// What an authentic end may hand on, kept from what the other end has said.

#include <map>
#include <string>

#include "firmware/can/frames.hpp"
#include "firmware/secoc/frames.hpp"
#include "firmware/secoc/map_records.hpp"
#include "firmware/wire/codec.hpp"
#include "tests/fuzz/input.hpp"

namespace s4tp::fuzz {

/// What a frame says. Of a map header all but its CRC and counter: of headers that say the same any may come out.
inline std::string text_of(const hal::CanFrame& frame) {
  std::string text(1, static_cast<char>(frame.id));
  text.append(reinterpret_cast<const char*>(frame.data), 8);
  if (frame.id == wire::kMapHeaderId) {
    text[1] = 0;
    text[2] = static_cast<char>(frame.data[1] & 0xF0U);
  }
  return text;
}

/// A map as its frames say it, the newest of each place.
class Picture {
 public:
  void take(const hal::CanFrame& can_frame) {
    const wire::Frame frame = to_wire(can_frame);
    secoc::RecordPlace place;
    if (head_.take(frame) || !secoc::find_place(frame, place)) return;
    Record& record = records_[place.record];
    if (place.parts > 0) record.parts = place.parts;
    record.texts[place.part] = text_of(can_frame);
  }
  [[nodiscard]] bool begun() const { return head_.whole(); }
  /// The head and the records that it names.
  [[nodiscard]] std::string text() const {
    std::string text;
    for (int i = 0; i < secoc::MapHead::kFrames; ++i) text += text_of(to_hal(head_.frame(i)));
    for (const auto& [number, record] : records_) {
      if (!head_.in_use(number)) continue;
      for (const auto& [part, words] : record.texts) {
        if (part < record.parts) text += words;
      }
    }
    return text;
  }

 private:
  struct Record {
    int parts = 0;
    std::map<int, std::string> texts;
  };
  secoc::MapHead head_;
  std::map<int, Record> records_;
};

/// Commands, motion groups or track lists that have come out: each whole, newer than all before.
class Taken {
 public:
  /// \param number  when the frame was said  \param frames  of its group, said then
  void take(const hal::CanFrame& frame, int number, int frames) {
    if (secoc::begins(frame.id)) {
      expect(missing_ == 0, "whole");
      expect(number > newest_, "newer than all before");
      newest_ = number;
      missing_ = frames;
    }
    expect(number == newest_, "of one group");
    --missing_;
  }
  void end() const { expect(missing_ == 0, "whole"); }

 private:
  int newest_ = -1;
  int missing_ = 0;  ///< frames of the newest group, yet to come
};

/// The map in force: what one of the companions was made for, and none of an older one.
class MapTaken {
 public:
  void said(const hal::CanFrame& frame) { said_.take(frame); }
  /// A companion has been made for the map as it was said.
  void sealed() { sealed_[said_.text()] = ++companions_; }
  void take(const hal::CanFrame& frame) { taken_.take(frame); }
  void end() {
    if (!taken_.begun()) return;
    const auto sealed = sealed_.find(taken_.text());
    expect(sealed != sealed_.end(), "the map in force was sealed by the world");
    expect(sealed->second >= in_force_, "no older map after a newer");
    in_force_ = sealed->second;
  }

 private:
  Picture said_, taken_;
  std::map<std::string, int> sealed_;  ///< and by which companion last
  int companions_ = 0;
  int in_force_ = 0;
};

}  // namespace s4tp::fuzz
