#include "sim_host/campaign/threshold.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>

#include "algo/core/math.hpp"
#include "algo/sadrf/risk.hpp"
#include "sim_host/world/engine_factory.hpp"
#include "sim_host/world/traffic/traffic_engine.hpp"

namespace s4tp::campaign {
namespace {

constexpr int kTicksPerSnapshot = 10;
constexpr std::size_t kEvery = 10;  // snapshots from one horizon to the next: 1 s
constexpr std::size_t kWindow = 3;  // steps over which a curvature is taken, as for others (method.md 3)
constexpr float kReachM = 100.0F;

/// A car's way: its state at each snapshot from the first on.
struct Drive {
  std::size_t first = 0;
  std::vector<Track> states;
  [[nodiscard]] const Track* at(std::size_t snapshot) const {
    const bool seen = snapshot >= first && snapshot - first < states.size();
    return seen ? &states[snapshot - first] : nullptr;
  }
};

using Drives = std::map<int, Drive>;

Drives watch(const scenario::Scenario& scenario, const CalibrationOptions& options, std::uint64_t seed) {
  const std::unique_ptr<traffic::TrafficEngine> engine =
      world::make_engine(scenario, {scenario::Engine::kBuiltin, seed});
  Drives drives;
  const auto count = static_cast<std::size_t>(std::lround(options.duration_s / static_cast<double>(kStepS)));
  const map::Vec2 origin = scenario.network.lanes.front().centre.points().front();
  for (std::size_t i = 0; i < count; ++i) {
    for (int tick = 0; tick < kTicksPerSnapshot; ++tick) engine->step(nullptr);
    for (const traffic::CarState& car : engine->cars()) {
      Drive& drive = drives[car.id];
      if (drive.states.empty()) drive.first = i;
      if (drive.first + drive.states.size() != i) continue;  // was gone in between
      Track track;
      track.centre = {static_cast<float>(car.centre.x - origin.x),
                      static_cast<float>(car.centre.y - origin.y),
                      wrap_angle(static_cast<float>(car.heading_rad))};
      track.speed_mps = std::max(static_cast<float>(car.speed_mps), 0.0F);
      track.length_m = static_cast<float>(car.length_m);
      track.width_m = static_cast<float>(car.width_m);
      drive.states.push_back(track);
    }
  }
  return drives;
}

Box box_of(const Track& track) {
  return {track.centre, track.length_m, track.width_m};
}

std::set<int> touched(const Drives& drives) {
  std::set<int> result;
  for (auto a = drives.begin(); a != drives.end(); ++a) {
    for (auto b = std::next(a); b != drives.end(); ++b) {
      const std::size_t first = std::max(a->second.first, b->second.first);
      for (std::size_t i = first; a->second.at(i) != nullptr && b->second.at(i) != nullptr; ++i) {
        const Track& one = *a->second.at(i);
        const Track& other = *b->second.at(i);
        if (distance(position(one.centre), position(other.centre)) > one.length_m + other.length_m) continue;
        if (!overlap(box_of(one), box_of(other), 0.0F)) continue;
        result.insert({a->first, b->first});
        break;
      }
    }
  }
  return result;
}

/// A driver as our own: wheelbase 0.6, rear axle 0.3 of the length behind the centre.
Parameters in_his_place(const Track& track, const ThresholdCell& cell) {
  Parameters parameters;
  sadrf::choose_risk(cell.preset, cell.look_ahead, parameters);
  parameters.vehicle.length_m = track.length_m;
  parameters.vehicle.width_m = track.width_m;
  parameters.vehicle.wheelbase_m = 0.6F * track.length_m;
  parameters.vehicle.rear_overhang_m = 0.2F * track.length_m;
  return parameters;
}

Trajectory driven(const Drive& drive, std::size_t start) {
  Trajectory trajectory;
  for (std::size_t k = 0; k < kTrajectoryPoints; ++k) {
    const Track& now = *drive.at(start + k);
    const Track& before = *drive.at(start + k - kWindow);
    const float way_m = distance(position(before.centre), position(now.centre));
    const float turned_rad = wrap_angle(now.centre.heading_rad - before.centre.heading_rad);
    TrajectoryPoint& point = trajectory.points[k];
    point.rear_axle = shift_ahead(now.centre, -0.3F * now.length_m);
    point.speed_mps = now.speed_mps;
    point.curvature_1pm = std::clamp(turned_rad / std::max(way_m, 0.5F), -0.2F, 0.2F);
  }
  return trajectory;
}

/// The others near the driver, with what they will have done.
void see(const Drives& drives, int id, std::size_t start, scene::Scene& scene, satp::KinematicSet& others) {
  const Point here = position(drives.at(id).at(start)->centre);
  std::vector<std::pair<float, const Drive*>> near;
  for (const auto& [other, drive] : drives) {
    if (other == id || drive.at(start) == nullptr || drive.at(start + kHorizonSteps) == nullptr) continue;
    const float away_m = distance(here, position(drive.at(start)->centre));
    if (away_m < kReachM) near.emplace_back(away_m, &drive);
  }
  std::sort(near.begin(), near.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [away_m, drive] : near) {
    scene::Agent agent;
    agent.track = *drive->at(start);
    satp::Mode mode;
    mode.probability = 1.0F;
    for (std::size_t k = 0; k < kHorizonSteps; ++k) mode.steps[k] = drive->at(start + k + 1)->centre;
    if (!scene.agents.push(agent) || !others.agents.push(mode)) return;
  }
}

void add_drives(const Drives& drives, Calibration& calibration) {
  const std::set<int> left_out = touched(drives);
  calibration.drives += static_cast<int>(drives.size());
  calibration.left_out += static_cast<int>(left_out.size());
  const auto scene = std::make_unique<scene::Scene>();
  const auto area = std::make_unique<sadrf::DrivableArea>();
  sadrf::build_drivable(nullptr, *area);
  for (const auto& [id, drive] : drives) {
    if (left_out.contains(id)) continue;
    for (std::size_t start = drive.first + kWindow; drive.at(start + kHorizonSteps) != nullptr;
         start += kEvery) {
      scene->agents.clear();
      satp::KinematicSet others;
      see(drives, id, start, *scene, others);
      const Trajectory trajectory = driven(drive, start);
      for (ThresholdCell& cell : calibration.cells) {
        sadrf::RiskProfile profile;
        sadrf::exact_risk(*scene, *area, {}, others, trajectory, in_his_place(*drive.at(start), cell),
                          profile);
        cell.risks.insert(cell.risks.end(), std::begin(profile.obstacle), std::end(profile.obstacle));
      }
    }
  }
}

}  // namespace

float ThresholdCell::percentile(double share) const {
  std::vector<float> sorted = risks;
  const auto at =
      sorted.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(sorted.size() - 1));
  std::nth_element(sorted.begin(), at, sorted.end());
  return *at;
}

Calibration empty_calibration() {
  Calibration calibration;
  for (const sadrf::FieldPreset preset : {sadrf::FieldPreset::kPaper, sadrf::FieldPreset::kKolekar2020}) {
    for (const sadrf::LookAhead look_ahead : {sadrf::LookAhead::kShrinking, sadrf::LookAhead::kFixed}) {
      calibration.cells.push_back({preset, look_ahead, {}});
    }
  }
  return calibration;
}

void calibrate(const scenario::Scenario& scenario, const CalibrationOptions& options,
               Calibration& calibration) {
  for (int i = 0; i < options.episodes; ++i) {
    add_drives(watch(scenario, options, options.first_seed + static_cast<std::uint64_t>(i)), calibration);
    if (options.on_episode) options.on_episode(i + 1);
  }
}

}  // namespace s4tp::campaign
