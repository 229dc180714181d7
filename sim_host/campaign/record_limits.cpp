#include "sim_host/campaign/record_limits.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>

#include "sim_host/campaign/episode_record.hpp"

namespace s4tp::campaign {
namespace {

using nlohmann::ordered_json;

[[noreturn]] void refuse(const std::string& name, const ordered_json& json, const std::string& accepted) {
  const std::string text = json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
  throw std::runtime_error(name + ": " + text.substr(0, 60) + "; accepted is " + accepted);
}

void check_texts(const ordered_json& header, const char* key) {
  const ordered_json& list = header.at(key);
  const bool texts = list.is_array() && !list.empty() &&
                     std::all_of(list.begin(), list.end(), [](const auto& one) { return one.is_string(); });
  if (!texts) refuse(key, list, "a list of texts, at least one");
}

/// What two campaigns must have in common for a cell of both to be one: else its row would mix two things.
std::string differs_in(const ordered_json& one, const ordered_json& other, const std::string& scenario) {
  for (const char* const key : {"parameters_crc", "wire_version", "build"}) {
    if (one.value(key, ordered_json()) != other.value(key, ordered_json())) return key;
  }
  const auto digest = [&](const ordered_json& header) {
    for (const ordered_json& each : header.at("scenarios")) {
      if (each.at("name") == scenario) return each.at("digest");
    }
    return ordered_json();
  };
  return digest(one) == digest(other) ? std::string() : "the files of " + scenario;
}

}  // namespace

ordered_json parse_json(const std::string& text) {
  return ordered_json::parse(text, [](int depth, ordered_json::parse_event_t, const ordered_json&) {
    if (depth > kJsonNesting) {
      throw std::runtime_error("nested more than " + std::to_string(kJsonNesting) + " deep");
    }
    return true;
  });
}

std::uint64_t whole_number(const ordered_json& json, const std::string& name, std::uint64_t low,
                           std::uint64_t high) {
  const bool there = json.is_number_unsigned() || (json.is_number_integer() && json.get<std::int64_t>() >= 0);
  if (!there || json.get<std::uint64_t>() < low || json.get<std::uint64_t>() > high) {
    refuse(name, json, "a whole number from " + std::to_string(low) + " to " + std::to_string(high));
  }
  return json.get<std::uint64_t>();
}

double figure(const ordered_json& json, const std::string& name, double low, double high) {
  if (!json.is_number() || !(json.get<double>() >= low && json.get<double>() <= high)) {
    std::ostringstream accepted;
    accepted << "a number from " << low << " to " << high;
    refuse(name, json, accepted.str());
  }
  return json.get<double>();
}

void check_header(const ordered_json& header) {
  (void)whole_number(header.at("episodes"), "episodes", 1, kEpisodesMax);
  (void)whole_number(header.at("first_seed"), "first_seed", 0, kSeedMax - kEpisodesMax);
  for (const char* const key : {"planners", "flavours", "traffic", "guard"}) check_texts(header, key);
  for (const char* const key : {"parameters_crc", "wire_version", "build"}) (void)header.at(key);
  for (const char* const key : {"perception", "parameters"}) {
    if (!header.at(key).is_string()) refuse(key, header.at(key), "a text");
  }
  for (const ordered_json& scenario : header.at("scenarios")) {
    for (const char* const key : {"name", "argument", "digest"}) {
      if (!scenario.at(key).is_string()) refuse("scenarios", scenario, "texts: name, argument, digest");
    }
  }
  std::set<Cell> cells;
  const ordered_json& list = header.at("cells");
  if (!list.is_array() || list.empty()) refuse("cells", list, "a list, at least one");
  for (const ordered_json& json : list) {
    if (!cells.insert(cell_of(json)).second) refuse("cells", json, "each cell once");
  }
}

void check_planned(const ordered_json& header, const EpisodeRow& row) {
  const auto first = header.at("first_seed").get<std::uint64_t>();
  const auto episodes = header.at("episodes").get<std::uint64_t>();
  const std::uint64_t seed = row.metrics.seed;
  if (seed < first || seed - first >= episodes) {
    throw std::runtime_error("seed " + std::to_string(seed) + " was never planned: this campaign has " +
                             std::to_string(first) + " to " + std::to_string(first + episodes - 1));
  }
  const ordered_json cell = cell_json(row.cell);
  const ordered_json& cells = header.at("cells");
  if (std::find(cells.begin(), cells.end(), cell) == cells.end()) {
    throw std::runtime_error(words(row.cell) + " was never planned: this campaign has no such cell");
  }
}

void check_poolable(const std::vector<ordered_json>& headers) {
  std::map<Cell, const ordered_json*> first;
  for (const ordered_json& header : headers) {
    for (const ordered_json& json : header.at("cells")) {
      const auto [known, fresh] = first.emplace(cell_of(json), &header);
      const std::string what = fresh ? "" : differs_in(*known->second, header, known->first.scenario);
      if (!what.empty()) {
        throw std::runtime_error(words(known->first) + " was driven by two campaigns that differ in " + what +
                                 ": one row would mix them; report them apart");
      }
    }
  }
}

}  // namespace s4tp::campaign
