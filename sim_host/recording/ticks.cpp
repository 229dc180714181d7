#include "sim_host/recording/ticks.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "firmware/wire/codec.hpp"

namespace s4tp::recording {
namespace {

constexpr unsigned kCounterMask = 0xF;

const wire::MessageInfo* find_message(std::uint32_t id) {
  const auto* const found = std::find_if(std::begin(wire::kMessages), std::end(wire::kMessages),
                                         [id](const wire::MessageInfo& message) { return message.id == id; });
  return found == std::end(wire::kMessages) ? nullptr : found;
}

}  // namespace

bool sent_by_ecu(const wire::Frame& frame) {
  const wire::MessageInfo* const message = find_message(frame.id);
  return message != nullptr && message->sender[0] == 'E';
}

std::string words(const wire::Frame& frame) {
  const wire::MessageInfo* const message = find_message(frame.id);
  char hex[8];
  std::snprintf(hex, sizeof hex, " %03X#", frame.id);
  std::string text = std::string(message == nullptr ? "unknown" : message->name) + hex;
  for (int i = 0; i < frame.length && i < 8; ++i) {
    std::snprintf(hex, sizeof hex, "%02X", frame.data[i]);
    text += hex;
  }
  return text;
}

bool same(const wire::Frame& a, const wire::Frame& b) {
  if (a.id != b.id || a.length != b.length) return false;
  if (std::equal(a.data, a.data + a.length, b.data)) return true;
  wire::CycleStatistics first;
  wire::CycleStatistics second;
  return wire::decode(a, first) && wire::decode(b, second) && first.slips == second.slips &&
         (a.data[1] & kCounterMask) == (b.data[1] & kCounterMask);
}

bool TickReader::next(RecordedTick& tick) {
  Record record;
  while (!ended_) {
    if (!series_.next(record)) {
      ended_ = true;
      break;
    }
    const bool is_comment = !record.comment.empty();
    const bool miss = is_comment && record.comment.starts_with("# miss");
    if (is_comment && !miss) {
      if (record.comment.starts_with("# s4tp log:")) header_ = record.comment;
      continue;
    }
    const wire::Frame& frame = record.logged.frame;
    if (!is_comment && sent_by_ecu(frame)) {
      if (!ticked_) continue;  // it says that it is there, before the world begins
      pending_.from_ecu.push_back(frame);
      pending_.lines.push_back(record.line);
      continue;
    }
    bool complete = false;
    if (ticked_) {
      tick = std::exchange(pending_, {});
      ticked_ = false;
      complete = true;
    }
    if (miss) {
      ++pending_.misses;
    } else {
      if (pending_.from_world.empty()) pending_.place = series_.place();
      pending_.from_world.push_back(frame);
      if (frame.id == wire::kTickId) {
        if (!begin_us_) begin_us_ = record.logged.time_us;
        pending_.number = ticks_++;
        pending_.time_us = record.logged.time_us - *begin_us_;
        ticked_ = true;
      }
    }
    if (complete) return true;
  }
  if (!ticked_ || !series_.damage().empty()) return false;
  tick = std::exchange(pending_, {});
  ticked_ = false;
  return true;
}

}  // namespace s4tp::recording
