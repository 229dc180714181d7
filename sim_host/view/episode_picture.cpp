#include "sim_host/view/episode_picture.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "sim_host/metrics/metrics.hpp"
#include "sim_host/view/haze.hpp"
#include "sim_host/view/svg.hpp"

namespace s4tp::view {
namespace {

using campaign::CycleTrace;
using campaign::EpisodeResult;
using map::Vec2;

constexpr double kPixelsPerMetre = 8.0;
constexpr double kChartHeightPx = 150.0;
constexpr double kReachM = 48.0;  // half the width of what is shown
constexpr double kCellM = 1.0;

const char* const kEgoColour = "#c0392b";
const char* const kOtherColour = "#2d6da3";
const char* const kPlanColour = "#e67e22";

double obstacle_peak(const CycleTrace& cycle) {
  return *std::max_element(std::begin(cycle.risk.obstacle), std::end(cycle.risk.obstacle));
}

/// The cycle the picture shows: the last one before a collision, else the one of the highest risk after
/// entry, else (a planner that computes none) the one half-way.
const CycleTrace* tensest(const EpisodeResult& result, double entry_ms) {
  const std::vector<CycleTrace>& cycles = result.trace->cycles;
  if (cycles.empty()) return nullptr;
  if (result.recording.ending == traffic::Ending::kCollision) return &cycles.back();
  const CycleTrace* best = &cycles[cycles.size() / 2];
  for (const CycleTrace& cycle : cycles) {
    if (cycle.record.plan.start_ms >= entry_ms && obstacle_peak(cycle) > obstacle_peak(*best)) best = &cycle;
  }
  return best;
}

void draw_road(Svg& svg, const map::Network& network) {
  for (const map::Lane& lane : network.lanes) {
    svg.line(lane.centre.points(), {.colour = "#cfcfca", .width_m = lane.width_m + 0.3});
  }
  for (const map::Lane& lane : network.lanes) {
    svg.line(lane.centre.points(), {.colour = "#e4e4df", .width_m = lane.width_m - 0.15});
  }
}

std::string heat_colour(double value) {
  const int green = static_cast<int>(215.0 * (1.0 - value));
  char colour[16];
  std::snprintf(colour, sizeof colour, "#ff%02x%02x", green, green / 4);
  return colour;
}

/// The other drivers' fields at the moment shown.
void draw_fields(Svg& svg, const traffic::Snapshot& now, Vec2 origin, Vec2 low, Vec2 high) {
  const Haze haze(now.others, origin);
  for (double x = std::floor(low.x); x < high.x; x += kCellM) {
    for (double y = std::floor(low.y); y < high.y; y += kCellM) {
      const double shown = haze.at({x + kCellM / 2, y + kCellM / 2});
      if (shown > 0.0) svg.cell({x, y}, kCellM, heat_colour(shown), 0.15 + 0.55 * shown);
    }
  }
}

void draw_thoughts(Svg& svg, const CycleTrace& cycle, Vec2 origin) {
  for (const satp::AgentPrediction& agent : cycle.predictions) {
    for (const satp::Mode& mode : agent.modes) {
      std::vector<Vec2> line;
      for (const Pose& pose : mode.steps) line.push_back({pose.x_m + origin.x, pose.y_m + origin.y});
      svg.line(line, {.colour = kOtherColour,
                      .width_m = 0.35,
                      .opacity = 0.25 + 0.7 * static_cast<double>(mode.probability)});
    }
  }
  std::vector<Vec2> plan;
  for (const TrajectoryPoint& point : cycle.record.plan.trajectory.points) {
    plan.push_back({point.rear_axle.x_m + origin.x, point.rear_axle.y_m + origin.y});
  }
  svg.line(plan, {.colour = kPlanColour, .width_m = 0.6, .opacity = 0.95});
}

void draw_cars(Svg& svg, const traffic::Recording& recording, const traffic::Snapshot& now) {
  std::vector<Vec2> way;
  for (const traffic::Snapshot& snapshot : recording.snapshots) way.push_back(snapshot.ego.centre);
  svg.line(way, {.colour = kEgoColour, .width_m = 0.25, .opacity = 0.6, .dashed = true});
  for (const traffic::CarState& car : now.others) {
    svg.box(car.centre, car.heading_rad, car.length_m, car.width_m, kOtherColour, 0.95);
    char speed[16];
    std::snprintf(speed, sizeof speed, "%.0f", car.speed_mps);
    svg.text({car.centre.x - 0.8, car.centre.y - 0.5}, speed, 11, "#ffffff");
  }
  svg.box(now.ego.centre, now.ego.heading_rad, now.ego.length_m, now.ego.width_m, kEgoColour, 1.0);
}

/// One curve over the episode in a strip of the chart area.
void draw_curve(Svg& svg, double top_px, double height_px, const std::vector<double>& values,
                double full_scale, const std::string& colour, const std::string& label) {
  const double width = svg.width_px() - 20.0;
  std::vector<Vec2> line;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double share = std::clamp(values[i] / full_scale, 0.0, 1.0);
    line.push_back({10.0 + width * static_cast<double>(i) /
                               std::max<double>(1.0, static_cast<double>(values.size() - 1)),
                    top_px + height_px * (1.0 - share)});
  }
  svg.line_px(line, colour, 1.6);
  svg.text_px(14.0, top_px + 11.0, label, 11, colour);
}

}  // namespace

void draw_episode(const scenario::Scenario& scenario, const EpisodeResult& result,
                  const std::filesystem::path& file) {
  const traffic::Recording& recording = result.recording;
  if (recording.snapshots.empty()) return;
  // Vehicle time starts with the pre-roll, the recording's time at entry.
  const double pre_roll_s = -recording.snapshots.front().time_s;
  const CycleTrace* cycle = tensest(result, 1000.0 * pre_roll_s);
  const double shown_s =
      cycle != nullptr ? static_cast<double>(cycle->record.plan.start_ms) / 1000.0 - pre_roll_s : 0.0;
  const auto now = std::min_element(recording.snapshots.begin(), recording.snapshots.end(),
                                    [&](const auto& a, const auto& b) {
                                      return std::abs(a.time_s - shown_s) < std::abs(b.time_s - shown_s);
                                    });

  const Vec2 low{now->ego.centre.x - kReachM, now->ego.centre.y - 0.75 * kReachM};
  const Vec2 high{now->ego.centre.x + kReachM, now->ego.centre.y + 0.75 * kReachM};
  Svg svg(low, high, kPixelsPerMetre, kChartHeightPx);
  draw_road(svg, scenario.network);
  draw_fields(svg, *now, result.origin, low, high);
  if (cycle != nullptr) draw_thoughts(svg, *cycle, result.origin);
  draw_cars(svg, recording, *now);

  char title[200];
  std::snprintf(title, sizeof title, "%s, seed %llu: %s after %.1f s; shown at %.1f s, %.1f m/s",
                recording.scenario.c_str(), static_cast<unsigned long long>(recording.seed),
                metrics::ending_name(recording.ending), recording.snapshots.back().time_s, now->time_s,
                now->ego.speed_mps);
  svg.rectangle_px(0, 0, svg.width_px(), 24, "#ffffffcc");
  svg.text_px(8, 17, title, 14);
  svg.text_px(svg.width_px() - 330, 17, "orange: plan   blue: predictions   red field: their risk", 11,
              "#555");

  std::vector<double> speeds;
  for (const traffic::Snapshot& snapshot : recording.snapshots) speeds.push_back(snapshot.ego.speed_mps);
  std::vector<double> risks;
  for (const CycleTrace& one : result.trace->cycles) risks.push_back(obstacle_peak(one));
  const double chart_px = svg.map_height_px();
  svg.rectangle_px(0, chart_px, svg.width_px(), kChartHeightPx, "#ffffff");
  draw_curve(svg, chart_px + 6, kChartHeightPx / 2 - 12, speeds, 15.0, kEgoColour, "speed, 0 .. 15 m/s");
  draw_curve(svg, chart_px + kChartHeightPx / 2 + 4, kChartHeightPx / 2 - 12, risks, 40000.0, "#8e44ad",
             "largest obstacle risk of the plan, 0 .. 40,000");
  svg.save(file);
}

}  // namespace s4tp::view
