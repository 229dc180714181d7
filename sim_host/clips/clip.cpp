#include "sim_host/clips/clip.hpp"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

namespace s4tp::clips {
namespace {

using nlohmann::json;

constexpr double kSampled_m = 2.0;  // between the centre line's points

// Beyond these a number is no recording's. Text and roads are limited as a whole: a few packed bytes, or two
// points far apart, could be any number of bytes or points.
constexpr std::size_t kTextBytes = 32U << 20U;
constexpr double kFar_m = 1e8;
constexpr double kShortestLane_m = 0.1;
constexpr double kLongestLane_m = 1e4;
constexpr double kWidestLane_m = 100.0;
constexpr double kRoads_m = 1e6;
constexpr double kFastest_mps = 200.0;
constexpr double kTurned_rad = 1000.0;
constexpr double kLargestVehicle_m = 100.0;
constexpr double kLastStep = 1e5;

/// Reads gzip and plain text alike.
std::string text_of(const std::filesystem::path& file) {
  if (!std::filesystem::is_regular_file(file))
    throw std::runtime_error(file.string() + ": is no ordinary file");
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> in(gzopen(file.c_str(), "rb"), gzclose);
  if (!in) throw std::runtime_error(file.string() + ": cannot be read");
  std::string text;
  char buffer[1 << 16];
  int count = 0;
  while (text.size() <= kTextBytes && (count = gzread(in.get(), buffer, sizeof buffer)) > 0)
    text.append(buffer, static_cast<std::size_t>(count));
  if (text.size() > kTextBytes)
    throw std::runtime_error(file.string() + ": longer than " + std::to_string(kTextBytes) + " bytes");
  if (count < 0) throw std::runtime_error(file.string() + ": damaged");
  return text;
}

double number(const json& value, const char* name, double low, double high) {
  if (value.is_number() && value.get<double>() >= low && value.get<double>() <= high)
    return value.get<double>();
  std::ostringstream text;
  text << name << ": accepted is a number from " << low << " to " << high;
  throw std::runtime_error(text.str());
}

double number(const json& record, const char* name, double low, double high, double missing) {
  const auto found = record.find(name);
  return found == record.end() ? missing : number(*found, name, low, high);
}

map::Vec2 place_of(const json& x, const json& y) {
  return {number(x, "x", -kFar_m, kFar_m), number(y, "y", -kFar_m, kFar_m)};
}

map::Polyline line_of(const json& points) {
  std::vector<map::Vec2> line;
  for (const json& point : points) line.push_back(place_of(point.at(0), point.at(1)));
  return map::Polyline(line);
}

void require(bool holds, const char* what) {
  if (!holds) throw std::runtime_error(what);
}

ClipLane lane_of(const json& record) {
  const map::Polyline left = line_of(record.at("left"));
  const map::Polyline right = line_of(record.at("right"));
  require(left.length_m() <= kLongestLane_m, "a lane is longer than 10 km");
  ClipLane lane;
  std::vector<map::Vec2> centre;
  const int count = std::max(2, static_cast<int>(std::ceil(left.length_m() / kSampled_m)) + 1);
  double width_m = 0.0;
  for (int i = 0; i < count; ++i) {
    const double share = static_cast<double>(i) / (count - 1);
    const map::Vec2 a = left.at(share * left.length_m()).point;
    const map::Vec2 b = right.at(share * right.length_m()).point;
    const double here_m = std::hypot(a.x - b.x, a.y - b.y);
    require(here_m <= kWidestLane_m, "a lane is wider than 100 m");
    centre.push_back({0.5 * (a.x + b.x), 0.5 * (a.y + b.y)});
    width_m += here_m / count;
  }
  lane.centre = map::Polyline(centre);
  require(lane.centre.length_m() >= kShortestLane_m && lane.centre.length_m() <= kLongestLane_m,
          "a lane is shorter than 0.1 m or longer than 10 km");
  lane.width_m = width_m;
  if (const auto limit = record.find("speed_limit"); limit != record.end() && limit->is_number()) {
    lane.speed_limit_mps = number(*limit, "speed_limit", 0.1, kFastest_mps);
  }
  return lane;
}

int index_of(const std::map<std::string, int>& lanes, const json& id) {
  const auto found = lanes.find(id.get<std::string>());
  return found == lanes.end() ? -1 : found->second;
}

int neighbour(const std::map<std::string, int>& lanes, const json& record, const char* side) {
  const auto beside = record.find(side);
  if (beside == record.end() || beside->is_null() || !beside->value("same_dir", false)) return -1;
  return index_of(lanes, beside->at("id"));
}

void read_lanes(const json& records, Clip& clip) {
  std::map<std::string, int> index;
  double roads_m = 0.0;
  for (const auto& [id, record] : records.items()) {
    index.emplace(id, static_cast<int>(clip.lanes.size()));
    clip.lanes.push_back(lane_of(record));
    roads_m += clip.lanes.back().centre.length_m();
    require(roads_m <= kRoads_m, "the lanes are longer than 1000 km in all");
  }
  for (const auto& [id, record] : records.items()) {
    ClipLane& lane = clip.lanes[static_cast<std::size_t>(index.at(id))];
    for (const json& next : record.at("succ")) {
      if (const int to = index_of(index, next); to >= 0) lane.successors.push_back(to);
    }
    lane.left = neighbour(index, record, "adj_left");
    lane.right = neighbour(index, record, "adj_right");
  }
}

ClipVehicle vehicle_of(const json& record) {
  static const std::vector<std::string> motor{"car", "truck", "bus", "motorcycle", "priorityVehicle", "taxi"};
  ClipVehicle vehicle;
  vehicle.id = record.at("id").get<std::string>();
  vehicle.motor = std::find(motor.begin(), motor.end(), record.at("type").get<std::string>()) != motor.end();
  vehicle.length_m = number(record, "length", 0.1, kLargestVehicle_m, vehicle.length_m);
  vehicle.width_m = number(record, "width", 0.1, kLargestVehicle_m, vehicle.width_m);
  for (const json& row : record.at("states")) {
    const double step = number(row.at(0), "step", 0.0, kLastStep);
    require(step == std::floor(step), "step: accepted is a whole number");
    ClipState& state = vehicle.states[static_cast<int>(step)];
    state.centre = place_of(row.at(1), row.at(2));
    state.heading_rad = number(row.at(3), "heading", -kTurned_rad, kTurned_rad);
    state.speed_mps = number(row.at(4), "speed", -kFastest_mps, kFastest_mps);
  }
  return vehicle;
}

}  // namespace

bool ClipVehicle::seen(int first, int last) const {
  const auto from = states.find(first);
  const auto to = states.find(last);
  return from != states.end() && to != states.end() && std::distance(from, to) == last - first;
}

Clip load_clip(const std::filesystem::path& file) {
  try {
    const json record = json::parse(text_of(file));
    Clip clip;
    clip.id = record.at("id").get<std::string>();
    clip.dt_s = record.at("dt").get<double>();
    if (std::abs(clip.dt_s - 0.1) > 1e-6) throw std::runtime_error("dt must be 0.1 s");
    read_lanes(record.at("lanelets"), clip);
    for (const json& obstacle : record.at("obstacles")) {
      if (obstacle.value("role", "dynamic") == "dynamic") clip.vehicles.push_back(vehicle_of(obstacle));
    }
    return clip;
  } catch (const std::exception& error) {
    const std::string what = error.what();
    throw std::runtime_error(what.starts_with(file.string()) ? what : file.string() + ": " + what);
  }
}

std::vector<std::filesystem::path> clip_files(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  if (std::filesystem::is_directory(folder)) {
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      const std::string name = entry.path().filename().string();
      if (name.ends_with(".json") || name.ends_with(".json.gz")) files.push_back(entry.path());
    }
  }
  if (files.empty()) throw std::runtime_error(folder.string() + ": no clips (*.json, *.json.gz) there");
  std::sort(files.begin(), files.end());
  return files;
}

std::string family_of(const std::string& clip_id) {
  for (const auto& [part, family] :
       {std::pair{"US101", "US-101"}, {"Lanker", "Lankershim"}, {"Peach", "Peachtree"}, {"I80", "I-80"}}) {
    if (clip_id.find(part) != std::string::npos) return family;
  }
  return clip_id.substr(0, clip_id.find_first_of("0123456789"));
}

}  // namespace s4tp::clips
