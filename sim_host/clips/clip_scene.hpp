#pragma once
/// The firmware's scene of a clip: the vehicle asked about is watched, the nearest other one stands in our place.

#include <cstdint>

#include "algo/core/parameters.hpp"
#include "algo/scene/scene.hpp"
#include "sim_host/clips/clip.hpp"

namespace s4tp::clips {

/// Track id of the vehicle asked about.
inline constexpr std::uint8_t kAskedTrack = 1;

/// \pre the vehicle was seen from step - kPastSteps to step; nothing later is looked at
/// \param map  the scene points into it \return origin of the scene's frame in the clip's; headings are the same
map::Vec2 see(const Clip& clip, std::size_t vehicle, int step, const Parameters& parameters, LaneMap& map,
              scene::Scene& scene);

}  // namespace s4tp::clips
