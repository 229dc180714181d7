#include "sim_host/faults/minimizer.hpp"

#include <algorithm>
#include <cstdlib>
#include <vector>

namespace s4tp::faults {
namespace {

/// Every way in which a fault can be a step smaller, boldest first.
std::vector<Fault> smaller(const Fault& fault) {
  std::vector<Fault> result;
  const auto propose = [&](int from_tick, int ticks) {
    Fault one = fault;
    one.from_tick = from_tick;
    one.ticks = ticks;
    if (ticks >= 1 && ticks < fault.ticks) result.push_back(one);
  };
  // One that outlives the run loses what is beyond it first.
  if (fault.end_tick() > kRunTicks) propose(fault.from_tick, kRunTicks - fault.from_tick);
  const int half = fault.ticks / 2;
  propose(fault.from_tick, half);
  propose(fault.from_tick + fault.ticks - half, half);
  propose(fault.from_tick, fault.ticks - 1);
  propose(fault.from_tick + 1, fault.ticks - 1);
  const KindTraits& kind = traits(fault.kind);
  for (unsigned i = 0; i < kMessageCount; ++i) {
    Fault one = fault;
    one.messages &= ~(1U << i);
    if (one.messages != fault.messages && one.messages != 0U) result.push_back(one);
  }
  const int weakest = std::clamp(0, kind.intensity_min, kind.intensity_max);
  Fault weaker = fault;
  weaker.intensity = weakest + (fault.intensity - weakest) / 2;
  const bool amount = kind.intensity_max > 6;  // otherwise a choice, not an amount
  if (amount && weaker.intensity != fault.intensity) result.push_back(weaker);
  return result;
}

}  // namespace

FaultScript minimize(FaultScript script, const std::function<bool(const FaultScript&)>& fails, int trials) {
  const auto accepts = [&](const FaultScript& trial) {
    if (trials <= 0) return false;
    --trials;
    if (!fails(trial)) return false;
    script = trial;
    return true;
  };
  const auto leave_one_out = [&] {
    for (std::size_t i = 0; i < script.faults.size(); ++i) {
      FaultScript trial = script;
      trial.faults.erase(trial.faults.begin() + static_cast<std::ptrdiff_t>(i));
      if (accepts(trial)) return true;
    }
    return false;
  };
  const auto shrink_one = [&] {
    for (std::size_t i = 0; i < script.faults.size(); ++i) {
      for (const Fault& fault : smaller(script.faults[i])) {
        FaultScript trial = script;
        trial.faults[i] = fault;
        if (accepts(trial)) return true;
      }
    }
    return false;
  };
  while (leave_one_out() || shrink_one()) {
  }
  return script;
}

}  // namespace s4tp::faults
