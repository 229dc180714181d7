#include "algo/sadrf/futures.hpp"

#include "algo/core/check.hpp"

namespace s4tp::sadrf {

Futures all_modes(const scene::Scene& scene, const satp::PredictionSet& prediction,
                  const satp::KinematicSet& others) {
  Futures futures;
  bool room = true;
  for (int agent = 0; agent < scene.agents.size(); ++agent) {
    const Track* const track = &scene.agents[agent].track;
    bool predicted = false;
    for (const satp::AgentPrediction& of : prediction.agents) {
      if (of.agent != agent) continue;
      predicted = true;
      for (const satp::Mode& mode : of.modes)
        room = room && futures.push({&mode, mode.probability, agent, track});
    }
    if (predicted || agent >= others.agents.size()) continue;
    room = room && futures.push({&others.agents[agent], 1.0F, agent, track});
  }
  S4TP_ASSERT(room);
  return futures;
}

void keep_likeliest(Futures& futures) {
  int kept = 0;
  for (const Future& future : futures) {
    if (kept == 0 || futures[kept - 1].agent != future.agent) {
      futures[kept++] = future;
    } else if (future.probability > futures[kept - 1].probability) {
      futures[kept - 1] = future;
    }
  }
  futures.truncate(kept);
  for (Future& future : futures) future.probability = 1.0F;
}

}  // namespace s4tp::sadrf
