#pragma once
/// An instant that becomes a sample once it is known how it went on.

#include <memory>
#include <span>

#include "sim_host/train/meetings.hpp"
#include "sim_host/train/observer.hpp"
#include "sim_host/train/sample.hpp"
#include "sim_host/world/scenario/scenario.hpp"

namespace s4tp::train {

/// Snapshots a sample needs from its instant on: the lead, then the horizon; and those that settle an order.
inline constexpr std::size_t kLeadSnapshots = 1;
inline constexpr std::size_t kSampleSnapshots = 1 + kLeadSnapshots + kHorizonSteps;
inline constexpr std::size_t kSettledSnapshots = 1 + 80;

struct Instant {
  Sample sample;  ///< input and expectation; road, episode, time and scenario
  scene::Scene scene;
  std::shared_ptr<const LaneMap> map;  ///< the scene's
  int car[kMaxAgents] = {};            ///< who the watched ones really are; -1: nobody is there
};

/// \param others  as they are at the scene's time  \param origin  of the odometry frame
[[nodiscard]] Instant capture(const Observer& observer, const Parameters& parameters,
                              std::shared_ptr<const LaneMap> map,
                              const std::vector<traffic::CarState>& others, map::Vec2 origin);

/// Fills in plan, targets and labels. \param drive  snapshots every 0.1 s from the instant on, at least
/// kSampleSnapshots, at most kSettledSnapshots are read  \param touched  id of the car the ego touched in it
void complete(Instant& instant, const scenario::Scenario& scenario, const map::RouteGuide& guide,
              std::span<const traffic::Snapshot> drive, int touched, map::Vec2 origin,
              const Parameters& parameters);

}  // namespace s4tp::train
