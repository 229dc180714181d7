#include "sim_host/campaign/episode_record.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <type_traits>

#include "algo/core/versions.hpp"
#include "sim_host/campaign/digest.hpp"
#include "sim_host/campaign/record_limits.hpp"

namespace s4tp::campaign {
namespace {

using nlohmann::ordered_json;

constexpr const char* kKind = "s4tp campaign";
/// Of what an episode's line holds; 1: no post-encroachment times, 2: no time to be in.
constexpr int kVersion = 3;

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& what) {
  throw std::runtime_error(file.string() + ": " + what);
}

/// Every field of an episode with its key, in the order of the line.
template <class Row, class Visit>
void visit_fields(Row& row, const Visit& visit) {
  auto& cell = row.cell;
  visit("planner", cell.planner);
  visit("scenario", cell.scenario);
  visit("flavour", cell.flavour);
  visit("traffic", cell.traffic);
  visit("guarded", cell.guarded);
  visit("perception", cell.perception);
  auto& m = row.metrics;
  visit("seed", m.seed);
  visit("ending", m.ending);
  visit("cause", m.cause);
  visit("redrawn", m.redrawn);
  visit("collisions_at_fault", m.collisions_at_fault);
  visit("collisions_other_fault", m.collisions_other_fault);
  visit("collisions_competition_box", m.collisions_competition_box);
  visit("collided_standing", m.collided_standing);
  visit("duration_s", m.duration_s);
  visit("in_time_s", m.in_time_s);
  visit("distance_m", m.distance_m);
  visit("progress_share", m.progress_share);
  visit("mean_abs_jerk_mps3", m.mean_abs_jerk_mps3);
  visit("max_abs_jerk_mps3", m.max_abs_jerk_mps3);
  visit("rms_acceleration_mps2", m.rms_acceleration_mps2);
  visit("hardest_braking_mps2", m.hardest_braking_mps2);
  visit("max_lateral_mps2", m.max_lateral_mps2);
  visit("min_gap_m", m.min_gap_m);
  visit("mean_gap_m", m.encounters.mean_gap_m);
  visit("min_time_to_collision_s", m.min_time_to_collision_s);
  visit("min_post_encroachment_s", m.encounters.min_post_encroachment_s);
  visit("near_misses", m.encounters.near_misses);
  visit("min_time_gap_s", m.encounters.min_time_gap_s);
  visit("imposed_braking_mps2", m.encounters.imposed_braking_mps2);
  visit("rss_violation_share", m.encounters.rss_violation_share);
  visit("rss_violations", m.encounters.rss_violations);
  visit("comp1_success", m.comp1.success);
  visit("comp1_steps", m.comp1.steps);
  visit("comp1_goal_distance_m", m.comp1.goal_distance_m);
  visit("comp1_jerk_linear", m.comp1.jerk_linear);
  visit("comp1_jerk_angular", m.comp1.jerk_angular);
  visit("comp1_lane_centre_offset", m.comp1.lane_centre_offset);
  visit("comp1_obstacle", m.comp1.obstacle);
}

void read_value(const ordered_json& json, const std::string&, std::string& value) {
  json.get_to(value);
}
void read_value(const ordered_json& json, const std::string&, bool& value) {
  json.get_to(value);
}
void read_value(const ordered_json& json, const std::string& name, std::uint64_t& value) {
  value = whole_number(json, name, 0, kSeedMax);
}
void read_value(const ordered_json& json, const std::string& name, int& value) {
  value = static_cast<int>(whole_number(json, name, 0, kEpisodesMax));
}
void read_value(const ordered_json& json, const std::string& name, double& value) {
  value = name == "duration_s" ? figure(json, name, 0.0, kDurationMax_s)
                               : figure(json, name, -kFigureMax, kFigureMax);
}

}  // namespace

ordered_json cell_json(const Cell& cell) {
  return {cell.planner, cell.scenario, cell.flavour, cell.traffic, cell.guarded, cell.perception};
}

Cell cell_of(const ordered_json& json) {
  if (!json.is_array() || json.size() != 6) throw std::invalid_argument("a cell has six members");
  return {json.at(0), json.at(1), json.at(2), json.at(3), json.at(4), json.at(5)};
}

ordered_json header_of(const Campaign& campaign, const Shard& shard, const std::string& parameters_file) {
  const CampaignPlan& plan = campaign.plan;
  ordered_json scenarios = ordered_json::array();
  ordered_json cells = ordered_json::array();
  for (const CampaignCell& cell : campaign.cells) {
    const CampaignScenario& one = *cell.scenario;
    cells.push_back(cell_json(cell.cell));
    const ordered_json entry{{"name", one.scenario.name}, {"argument", one.argument}, {"digest", one.digest}};
    if (std::find(scenarios.begin(), scenarios.end(), entry) == scenarios.end()) scenarios.push_back(entry);
  }
  ordered_json guards = ordered_json::array();
  for (const bool guarded : plan.guards) guards.push_back(guarded ? "on" : "off");
  return {{"kind", kKind},
          {"version", kVersion},
          {"planners", plan.planners},
          {"scenarios", scenarios},
          {"flavours", plan.flavours},
          {"traffic", plan.traffic},
          {"guard", guards},
          {"perception", plan.perception},
          {"episodes", plan.episodes},
          {"first_seed", plan.first_seed},
          {"parameters", parameters_file},
          {"parameters_crc", parameters_crc(plan.parameters)},
          {"wire_version", kWireVersion},
          {"build", build_digest()},
          {"cells", cells},
          {"shard", std::to_string(shard.index) + "/" + std::to_string(shard.count)}};
}

std::string difference(const ordered_json& there, const ordered_json& here, const std::string& but) {
  std::string text;
  constexpr std::size_t kShown = 60;  // of a value: where it begins to differ says enough
  const auto shown = [](const std::string& value) {
    return value.size() > kShown ? value.substr(0, kShown) + "..." : value;
  };
  const auto note = [&](const std::string& key, const std::string& first, const std::string& second) {
    text += (text.empty() ? "" : "; ") + key + ": " + shown(first) + " there, " + shown(second) + " here";
  };
  for (const auto& [key, value] : here.items()) {
    if (key == but || key == "cells") continue;  // the cells follow from the rest
    if (!there.contains(key)) {
      note(key, "nothing", value.dump());
    } else if (there.at(key) != value) {
      note(key, there.at(key).dump(), value.dump());
    }
  }
  return text;
}

ordered_json to_json(const EpisodeRow& row) {
  ordered_json line;
  visit_fields(row, [&](const char* key, const auto& value) {
    if constexpr (std::is_same_v<decltype(value), const traffic::Ending&>) {
      line[key] = metrics::ending_name(value);
    } else {
      line[key] = value;
    }
  });
  return line;
}

EpisodeRow row_of(const ordered_json& line) {
  EpisodeRow row;
  visit_fields(row, [&](const char* key, auto& value) {
    if constexpr (std::is_same_v<decltype(value), traffic::Ending&>) {
      value = metrics::ending_of(line.at(key).get<std::string>());
    } else {
      read_value(line.at(key), key, value);
    }
  });
  return row;
}

Part read_part(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!std::filesystem::is_regular_file(file) || !stream)
    fail(file, "cannot be read");  // a device may never end
  Part part;
  std::string line;
  for (int number = 1; std::getline(stream, line) && !stream.eof(); ++number) {  // eof: no end of line
    try {
      ordered_json read = parse_json(line);
      if (number > 1) {
        part.rows.push_back(row_of(read));
        check_planned(part.header, part.rows.back());
      } else if (const ordered_json version = read.value("version", ordered_json(1));
                 read.at("kind") == kKind && version != kVersion) {
        const std::string text = version.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
        throw std::invalid_argument("holds version " + text.substr(0, 60) +
                                    " of the metrics, this program has version " + std::to_string(kVersion) +
                                    "; drive it again, or read it with the program that wrote it");
      } else if (read.at("kind") == kKind) {
        check_header(read);
        part.header = std::move(read);
      } else {
        throw std::invalid_argument("is of another kind");
      }
    } catch (const std::exception& error) {
      fail(file, "line " + std::to_string(number) + " is no part of a campaign: " + error.what());
    }
    part.whole_bytes += line.size() + 1;
  }
  return part;
}

EpisodeRecord::EpisodeRecord(const std::filesystem::path& file, const ordered_json& header) : file_(file) {
  descriptor_ = ::open(file.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (descriptor_ < 0) fail(file, std::strerror(errno));
  try {
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) fail(file, "a campaign is writing it now");
    Part part = read_part(file);
    if (part.header.is_null()) {
      if (::ftruncate(descriptor_, 0) != 0) fail(file, std::strerror(errno));
      write_line(header);
      return;
    }
    const std::string differs = difference(part.header, header);
    if (!differs.empty()) {
      fail(file, "holds episodes of another campaign and cannot be gone on with (" + differs +
                     "); name another --out, or remove it");
    }
    if (::ftruncate(descriptor_, static_cast<off_t>(part.whole_bytes)) != 0) fail(file, std::strerror(errno));
    found_ = std::move(part.rows);
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

EpisodeRecord::~EpisodeRecord() {
  ::close(descriptor_);
}

void EpisodeRecord::append(const EpisodeRow& row) {
  write_line(to_json(row));
}

void EpisodeRecord::write_line(const ordered_json& line) {
  const std::string text = line.dump() + '\n';
  if (::write(descriptor_, text.data(), text.size()) != static_cast<ssize_t>(text.size())) {
    fail(file_, std::strerror(errno));
  }
}

}  // namespace s4tp::campaign
