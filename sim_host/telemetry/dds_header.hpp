#pragma once
/// The head of a message: when, and in which frame.

#include <cstdint>

#include "sim_host/telemetry/dds_messages.hpp"

namespace s4tp::telemetry {

using Header = std_msgs_msg_dds__Header_;

template <class Stamp>
void set_time(Stamp& stamp, std::uint32_t time_ms) {
  stamp.sec = static_cast<std::int32_t>(time_ms / 1000U);
  stamp.nanosec = time_ms % 1000U * 1'000'000U;
}

inline Header header(std::uint32_t time_ms, const char* frame, Arena& arena) {
  Header result{};
  set_time(result.stamp, time_ms);
  result.frame_id = arena.text(frame);
  return result;
}

}  // namespace s4tp::telemetry
