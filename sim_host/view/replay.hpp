#pragma once
/// An episode as a page: bird's-eye animation with plan, predictions and risk, and beside it why each plan
/// was chosen. One file that opens from disk and asks the network for nothing.

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "sim_host/campaign/cell.hpp"
#include "sim_host/campaign/episode.hpp"
#include "sim_host/world/scenario/scenario.hpp"

namespace s4tp::view {

/// An episode that was driven with a trace.
struct Replayed {
  const scenario::Scenario& scenario;
  const campaign::EpisodeResult& result;  ///< trace is there (EpisodeOptions::trace)
  const campaign::EpisodeRow& row;
  std::string command;                           ///< drives it again
  std::optional<campaign::EpisodeRow> recorded;  ///< what a campaign noted of it
};

/// VIEW-001 A replay is the episode that was recorded when every number noted of it comes out again to the
/// bit. \return the numbers that do not, in words: "duration_s: 7.31 then, 7.42 now"; empty: none
[[nodiscard]] std::string changed(const campaign::EpisodeRow& recorded, const campaign::EpisodeRow& now);

/// What replay.js animates: lengths in units of 0.05 m from "origin", times in ms since the ECU took over.
[[nodiscard]] nlohmann::ordered_json replay_data(const Replayed& episode);

/// File name of an episode's replay, alike for no two episodes.
[[nodiscard]] std::string replay_name(const campaign::Cell& cell, std::uint64_t seed);

/// \throws std::runtime_error when the file cannot be written
void write_replay(const Replayed& episode, const std::filesystem::path& file);

}  // namespace s4tp::view
