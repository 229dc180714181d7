#pragma once
/// Which Command frames on a bus of two processes answer the world (world_process.hpp, PROC-024).

#include "firmware/wire/frame.hpp"

namespace s4tp::nodes {

inline constexpr unsigned kOldestEcho = 10;  ///< in real time: ticks an answer may be late

/// \param tick    the world's, from 1  \param oldest  ticks an answer may be late
/// \param first   no answer came so far: the ECU does not trust the first TICK it sees and echoes 0
[[nodiscard]] bool answers_tick(const wire::Frame& frame, unsigned tick, unsigned oldest, bool first);

}  // namespace s4tp::nodes
