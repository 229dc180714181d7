#pragma once
/// The picture of an episode: bird's eye at its tensest moment with plan, predictions and risk field, the
/// ways driven, and below it speed and risk over time.

#include <filesystem>

#include "sim_host/campaign/episode.hpp"
#include "sim_host/world/scenario/scenario.hpp"

namespace s4tp::view {

/// \pre result.trace is there (EpisodeOptions::trace)
/// \throws std::runtime_error when the file cannot be written
void draw_episode(const scenario::Scenario& scenario, const campaign::EpisodeResult& result,
                  const std::filesystem::path& file);

}  // namespace s4tp::view
