#pragma once
/// What a record of episodes may say. Records come from other machines and other days: a number beyond these
/// is a broken file, not a drive.

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "sim_host/campaign/cell.hpp"

namespace s4tp::campaign {

inline constexpr std::uint64_t kSeedMax = 9'223'372'036'854'775'807U;
inline constexpr std::uint64_t kEpisodesMax = 1'000'000;  ///< of a cell
/// FILE-006 In a result that is compared (compare.hpp) each run stands once, with failures among its seeds
/// only.
inline constexpr std::uint64_t kComparedMax = 2'000'000;  ///< episodes in one document that is compared
inline constexpr double kDurationMax_s = 7'200.0;         ///< the longest time limit is half of it
inline constexpr double kFigureMax = 1e15;                ///< magnitude of any other figure
inline constexpr int kJsonNesting = 32;                   ///< of lists and objects within each other, at most

/// FILE-011 A document nested deeper than kJsonNesting is refused: comparing and printing it recurse.
/// \throws std::exception saying what is wrong
[[nodiscard]] nlohmann::ordered_json parse_json(const std::string& text);

/// A whole number that is there as such: neither 1.0 nor "1".
/// \throws std::runtime_error naming it and what is accepted
[[nodiscard]] std::uint64_t whole_number(const nlohmann::ordered_json& json, const std::string& name,
                                         std::uint64_t low, std::uint64_t high);

/// \throws std::runtime_error naming it and what is accepted
[[nodiscard]] double figure(const nlohmann::ordered_json& json, const std::string& name, double low,
                            double high);

/// FILE-004 A campaign's header: every key a reader needs, of its kind; 1 to kEpisodesMax episodes a cell,
/// each cell once. \throws std::exception naming what is wrong
void check_header(const nlohmann::ordered_json& header);

/// FILE-005 An episode that the campaign of this header never planned: of another cell, or with another seed.
/// \throws std::runtime_error naming it
void check_planned(const nlohmann::ordered_json& header, const EpisodeRow& row);

/// FILE-008 Two campaigns have a row in common only when they have parameters, wire version, build and that
/// scenario's files in common: else the row would mix two things.
/// \throws std::runtime_error naming the row and what differs
void check_poolable(const std::vector<nlohmann::ordered_json>& headers);

}  // namespace s4tp::campaign
