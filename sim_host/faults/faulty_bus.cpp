#include "sim_host/faults/faulty_bus.hpp"

#include <algorithm>
#include <utility>

#include "sim_host/faults/lies.hpp"
#include "sim_host/faults/sender_faults.hpp"
#include "sim_host/world/traffic/random.hpp"

namespace s4tp::faults {
namespace {

using wire::Frame;

bool happens(const Fault& fault, std::uint64_t random) {
  return static_cast<int>(random % 100U) < fault.intensity;
}

void lose(const Fault& fault, int tick, bool always, std::vector<Frame>& frames) {
  std::size_t place = 0;
  std::erase_if(frames, [&](const Frame& frame) {
    const std::uint64_t random = draw(fault, tick, place++);
    return contains(fault.messages, frame.id) && (always || happens(fault, random));
  });
}

void duplicate(const Fault& fault, int tick, std::vector<Frame>& frames) {
  std::vector<Frame> result;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    result.push_back(frames[i]);
    if (contains(fault.messages, frames[i].id) && happens(fault, draw(fault, tick, i))) {
      result.push_back(frames[i]);
    }
  }
  frames = result;
}

void reorder(const Fault& fault, int tick, std::vector<Frame>& frames) {
  if (!happens(fault, draw(fault, tick, 0))) return;
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (contains(fault.messages, frames[i].id)) places.push_back(i);
  }
  for (std::size_t i = places.size(); i > 1; --i) {
    std::swap(frames[places[i - 1]], frames[places[draw(fault, tick, i) % i]]);
  }
}

/// As a bus does it: one or two bits, eight in a row, or the end of the frame missing.
void damage(const Fault& fault, int tick, std::vector<Frame>& frames) {
  for (std::size_t i = 0; i < frames.size(); ++i) {
    Frame& frame = frames[i];
    const std::uint64_t random = draw(fault, tick, i);
    if (!contains(fault.messages, frame.id) || !happens(fault, random)) continue;
    const auto flip = [&](std::uint64_t bit) {
      frame.data[bit / 8U] = static_cast<std::uint8_t>(frame.data[bit / 8U] ^ (1U << (bit % 8U)));
    };
    const std::uint64_t more = random >> 8U;
    switch (more % 4U) {
      case 0:
        flip((more >> 4U) % 64U);
        break;
      case 1: {
        const std::uint64_t first = (more >> 4U) % 64U;
        flip(first);
        flip((first + 1U + (more >> 12U) % 63U) % 64U);
        break;
      }
      case 2: {
        const std::uint64_t start = (more >> 4U) % 57U;
        const std::uint64_t pattern = 1U + (more >> 12U) % 255U;
        for (unsigned k = 0; k < 8; ++k) {  // as bits travel: the highest of a byte first
          if (((pattern >> k) & 1U) != 0U) flip((start + k) / 8U * 8U + 7U - (start + k) % 8U);
        }
        break;
      }
      default:
        frame.length = static_cast<std::uint8_t>((more >> 4U) % 8U);
    }
  }
}

void burst(const Fault& fault, int tick, std::vector<Frame>& frames) {
  std::vector<Frame> foreign;
  for (int i = 0; i < fault.intensity; ++i) {
    const std::uint64_t random = draw(fault, tick, static_cast<std::size_t>(i));
    Frame frame;
    frame.id = 0x100U + static_cast<std::uint32_t>(random % 0x700U);
    frame.length = static_cast<std::uint8_t>((random >> 16U) % 9U);
    for (std::uint8_t& byte : frame.data) byte = static_cast<std::uint8_t>(random >> 24U);
    foreign.push_back(frame);
  }
  const bool first = fault.dice % 2U == 0U;
  frames.insert(first ? frames.begin() : frames.end(), foreign.begin(), foreign.end());
}

}  // namespace

FaultyBus::FaultyBus(const FaultScript& script) : last_tick_(-kPreRollTicks) {
  for (const Fault& fault : script.faults) {
    sources_.push_back({fault, {}, {}, {}});
    const int tail = fault.kind == FaultKind::kDelay ? fault.intensity : 0;
    last_tick_ = std::max(last_tick_, fault.end_tick() - 1 + tail);
  }
}

void FaultyBus::delay(const Fault& fault, int tick, Frames& frames, std::vector<Delayed>& delayed) {
  Frames in_time;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (fault.active(tick) && contains(fault.messages, frames[i].id)) {
      const auto late = static_cast<int>(draw(fault, tick, i) % static_cast<unsigned>(fault.intensity));
      delayed.push_back({tick + 1 + late, frames[i]});
    } else {
      in_time.push_back(frames[i]);
    }
  }
  frames.clear();
  std::erase_if(delayed, [&](const Delayed& one) {
    if (one.due_tick <= tick) frames.push_back(one.frame);
    return one.due_tick <= tick;
  });
  frames.insert(frames.end(), in_time.begin(), in_time.end());
}

void FaultyBus::apply(Source& source, int tick, Frames& frames, std::vector<Delayed>& delayed) {
  const Fault& fault = source.fault;
  if (fault.kind == FaultKind::kDelay) return delay(fault, tick, frames, delayed);
  if (!fault.active(tick)) return;
  switch (fault.kind) {
    case FaultKind::kLoss:
      return lose(fault, tick, false, frames);
    case FaultKind::kDeadMap:
    case FaultKind::kDeadPerception:
    case FaultKind::kDeadVehicle:
      return lose(fault, tick, true, frames);
    case FaultKind::kDuplicate:
      return duplicate(fault, tick, frames);
    case FaultKind::kReorder:
      return reorder(fault, tick, frames);
    case FaultKind::kCorrupt:
      return damage(fault, tick, frames);
    case FaultKind::kBurst:
      return burst(fault, tick, frames);
    case FaultKind::kBabble:
      return babble(fault, tick, frames);
    case FaultKind::kLongList:
      return lengthen(fault, tick, frames);
    default:
      break;
  }
  for (Frame& frame : frames) {
    if (!contains(fault.messages, frame.id)) continue;
    if (fault.kind == FaultKind::kStuck) {
      hold(fault, source.held, frame);
    } else if (fault.kind == FaultKind::kPattern) {
      overwrite(fault, frame);
    } else if (fault.kind == FaultKind::kLie) {
      tell_lie(fault, tick, frame);
    } else {
      shift_clock(fault, tick, frame);
    }
  }
}

std::vector<Frame> FaultyBus::to_ecu(int tick, Frames frames) {
  for (Source& source : sources_) apply(source, tick, frames, source.delayed_to_ecu);
  const bool lying = std::any_of(sources_.begin(), sources_.end(), [tick](const Source& source) {
    const FaultKind kind = source.fault.kind;
    return source.fault.active(tick) &&
           (kind == FaultKind::kStuck || kind == FaultKind::kPattern || kind == FaultKind::kLongList);
  });
  sealer_.pass(lying, frames);
  return frames;
}

std::vector<Frame> FaultyBus::to_world(int tick, Frames frames) {
  for (Source& source : sources_) {
    const FaultKind kind = source.fault.kind;
    const bool both_ways = kind == FaultKind::kLoss || kind == FaultKind::kDelay ||
                           kind == FaultKind::kDuplicate || kind == FaultKind::kCorrupt;
    if (both_ways) apply(source, tick, frames, source.delayed_to_world);
  }
  return frames;
}

hal::CanState FaultyBus::controller(int tick) const {
  constexpr hal::CanState kStates[] = {hal::CanState::kBusOff, hal::CanState::kDown, hal::CanState::kPassive};
  hal::CanState state = hal::CanState::kActive;
  for (const Source& source : sources_) {
    const Fault& fault = source.fault;
    if (fault.kind != FaultKind::kBusOff || !fault.active(tick)) continue;
    const hal::CanState wanted = kStates[fault.intensity];
    if (wanted != hal::CanState::kPassive || state == hal::CanState::kActive) state = wanted;
  }
  return state;
}

bool FaultyBus::plan_late(int tick) const {
  return std::any_of(sources_.begin(), sources_.end(), [tick](const Source& source) {
    return source.fault.kind == FaultKind::kLatePlan && source.fault.active(tick) &&
           happens(source.fault, draw(source.fault, tick, 0));
  });
}

bool FaultyBus::over(int tick) const {
  return tick > last_tick_;
}

}  // namespace s4tp::faults
