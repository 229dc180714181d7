#pragma once
/// Drives an episode with a planner of ours in the loop and makes training samples of it: at intervals the
/// world is forked, the ego drives several intentions from the same instant, and what the others then do
/// becomes the target (method.md 2).
///
/// \code
///   drive   --------x-----------x-------->      x  a fork: one sample of the drive, one of each branch,
///                   |\                             all with the same input and each with the plan it drove
///                   | o-----o----> 8 s          o  a later instant of a branch: a plain sample of its own,
///                    \--o-----o--> 8 s             so that the set knows egos who do not drive as ours do
/// \endcode

#include <cstdint>
#include <functional>
#include <string>

#include "algo/core/parameters.hpp"
#include "sim_host/train/sample.hpp"
#include "sim_host/world/nodes/perception.hpp"
#include "sim_host/world/scenario/scenario.hpp"

namespace s4tp::train {

struct DriveOptions {
  std::uint64_t seed = 0;
  std::uint64_t road = 0;  ///< Sample::road
  SampleScenario scenario = SampleScenario::kOther;
  std::string planner = "s4tp";
  bool guarded = true;
  bool noisy = false;      ///< perception as it is, in the branches too
  bool reporting = false;  ///< its samples are never learned from
  int branches = 3;        ///< of a fork
  int forks = 12;          ///< at most
  Parameters parameters;
};

struct DriveCounts {
  int forks = 0;
  int branches = 0;
  int collided = 0;  ///< branches in which the ego touched somebody
  int samples = 0;
  int forked = 0;         ///< of them samples of a fork's instant
  double driven_s = 0.0;  ///< simulated, branches included
  DriveCounts& operator+=(const DriveCounts& other);
};

/// TRAIN-011 The same scenario and options give the same samples to the bit. TRAIN-012 All samples of a fork
/// have the same input; branch 0 is the drive itself, and is left out where the episode ended within 3 s.
/// \throws as campaign::make_driver() and world::World
DriveCounts make_samples(const scenario::Scenario& scenario, const DriveOptions& options,
                         const std::function<void(const Sample&)>& sink);

}  // namespace s4tp::train
