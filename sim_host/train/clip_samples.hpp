#pragma once
/// Windows of recorded traffic as training samples, to join those of the simulation.

#include <functional>

#include "algo/core/parameters.hpp"
#include "sim_host/clips/windows.hpp"
#include "sim_host/train/sample.hpp"

namespace s4tp::train {

/// CLIP-005 A window of a vehicle that is not kept for judging gives a sample with one target, that vehicle. Nobody
/// knows the plan of who stands in our place, and what was then done is no intervention: the network is shown none
/// (kNoPlan). All windows of a vehicle are of one road, so that no part of a data set shares vehicles.
void make_clip_samples(const clips::Clip& clip, clips::Windows& windows, const Parameters& parameters,
                       const std::function<void(const Sample&)>& sink);

}  // namespace s4tp::train
