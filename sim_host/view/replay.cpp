#include "sim_host/view/replay.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "sim_host/campaign/episode_record.hpp"
#include "sim_host/metrics/metrics.hpp"
#include "sim_host/view/haze.hpp"
#include "sim_host/view/plan_numbers.hpp"
#include "sim_host/view/plan_words.hpp"
#include "sim_host/world/traffic/box.hpp"

namespace s4tp::view {
namespace {

using campaign::CycleTrace;
using map::Vec2;
using nlohmann::ordered_json;
using traffic::CarState;
using traffic::Snapshot;

constexpr double kUnitM = 0.05;
constexpr double kRoadReachM = 100.0;  // around the ego's way
constexpr double kHazeCellM = 1.0;
constexpr int kHazeColumns = 116;
constexpr int kHazeRows = 72;
constexpr int kStepsShown = 2;     // every so many of a horizon
constexpr double kSameCarM = 6.0;  // a track further from every car is none of them
constexpr double kFirstShownS = -0.05;

long thousandths(double value) {
  return std::lround(1000.0 * value);
}

/// Network coordinates to whole units around one place.
class Units {
 public:
  explicit Units(Vec2 origin) : origin_(origin) {}
  [[nodiscard]] std::array<long, 2> of(Vec2 point) const {
    return {std::lround((point.x - origin_.x) / kUnitM), std::lround((point.y - origin_.y) / kUnitM)};
  }
  /// The first point, then each one's distance from the one before.
  [[nodiscard]] std::vector<long> steps(const std::vector<Vec2>& points) const {
    std::vector<long> steps;
    std::array<long, 2> last{};
    for (const Vec2& point : points) {
      const std::array<long, 2> next = of(point);
      steps.insert(steps.end(), {next[0] - last[0], next[1] - last[1]});
      last = next;
    }
    return steps;
  }

 private:
  Vec2 origin_;
};

ordered_json road(const map::Network& network, const traffic::Recording& recording, const Units& units) {
  Vec2 low = recording.snapshots.front().ego.centre;
  Vec2 high = low;
  for (const Snapshot& snapshot : recording.snapshots) {
    low = {std::min(low.x, snapshot.ego.centre.x), std::min(low.y, snapshot.ego.centre.y)};
    high = {std::max(high.x, snapshot.ego.centre.x), std::max(high.y, snapshot.ego.centre.y)};
  }
  ordered_json lanes = ordered_json::array();
  for (const map::Lane& lane : network.lanes) {
    const auto& points = lane.centre.points();
    const auto [left, right] =
        std::minmax_element(points.begin(), points.end(), [](Vec2 a, Vec2 b) { return a.x < b.x; });
    const auto [bottom, top] =
        std::minmax_element(points.begin(), points.end(), [](Vec2 a, Vec2 b) { return a.y < b.y; });
    if (right->x < low.x - kRoadReachM || left->x > high.x + kRoadReachM || top->y < low.y - kRoadReachM ||
        bottom->y > high.y + kRoadReachM) {
      continue;
    }
    lanes.push_back({{"width_mm", thousandths(lane.width_m)},
                     {"junction", lane.in_junction},
                     {"line", units.steps(points)}});
  }
  return lanes;
}

double gap_m(const Snapshot& now) {
  double gap = -1.0;
  for (const CarState& car : now.others) {
    const double one = traffic::distance_m(traffic::box_of(now.ego), traffic::box_of(car));
    if (gap < 0.0 || one < gap) gap = one;
  }
  return gap;
}

std::vector<long> state(const CarState& car, const Units& units) {
  const auto at = units.of(car.centre);
  return {at[0], at[1], thousandths(car.heading_rad), std::lround(100.0 * car.speed_mps)};
}

ordered_json frame(const Snapshot& now, Vec2 origin, const Units& units) {
  std::vector<long> ego = state(now.ego, units);
  ego.insert(ego.end(), {std::lround(100.0 * now.ego.acceleration_mps2), thousandths(now.ego_steering_rad)});
  std::vector<long> others;
  for (const CarState& car : now.others) {
    others.push_back(car.id);
    for (const long value : state(car, units)) others.push_back(value);
  }
  const auto cell = [](double middle, int count) {
    return (std::floor(middle / kHazeCellM) - count / 2.0) * kHazeCellM;
  };
  const Vec2 low{cell(now.ego.centre.x, kHazeColumns), cell(now.ego.centre.y, kHazeRows)};
  const Vec2 high{low.x + kHazeColumns * kHazeCellM, low.y + kHazeRows * kHazeCellM};
  return {{"t", thousandths(now.time_s)},
          {"ego", ego},
          {"gap_cm", std::lround(100.0 * gap_m(now))},
          {"cars", others},
          {"haze_at", units.of(low)},
          {"haze", Haze(now.others, origin).grid(low, high, kHazeCellM)}};
}

/// The car a track stands for; -1: none.
int car_of(const Track& track, const Snapshot& now, Vec2 origin) {
  int id = -1;
  double nearest_m = kSameCarM;
  for (const CarState& car : now.others) {
    const double distance_m =
        std::hypot(track.centre.x_m + origin.x - car.centre.x, track.centre.y_m + origin.y - car.centre.y);
    if (distance_m >= nearest_m) continue;
    nearest_m = distance_m;
    id = car.id;
  }
  return id;
}

std::vector<long> costs(const planner::CostBreakdown& cost) {
  std::vector<long> values;
  for (const float term : {cost.progress, cost.speed, cost.jerk, cost.lateral, cost.lane, cost.risk}) {
    values.push_back(std::lround(std::clamp(10.0 * static_cast<double>(term), -1e9, 1e9)));
  }
  return values;
}

/// The largest of every few steps.
std::vector<long> peaks(const float (&series)[kHorizonSteps]) {
  std::vector<long> values;
  for (int i = 0; i < kHorizonSteps; i += kStepsShown) {
    values.push_back(std::lround(*std::max_element(series + i, series + i + kStepsShown)));
  }
  return values;
}

/// What the planner was told of the others, where that is not how they are.
ordered_json seen(const std::vector<Track>& tracks, Vec2 origin, const Units& units) {
  ordered_json boxes = ordered_json::array();
  for (const Track& track : tracks) {
    const auto at = units.of({track.centre.x_m + origin.x, track.centre.y_m + origin.y});
    boxes.push_back({at[0], at[1], thousandths(track.centre.heading_rad), thousandths(track.length_m),
                     thousandths(track.width_m)});
  }
  return boxes;
}

/// Not every planner does.
bool explains(const CycleTrace& cycle) {
  return cycle.record.explanation.candidate_count > 0;
}

ordered_json cycle_json(const CycleTrace& cycle, const Snapshot& now, Vec2 origin, const Units& units) {
  const auto moved = [&](const Pose& pose) { return Vec2{pose.x_m + origin.x, pose.y_m + origin.y}; };
  const planner::Explanation& e = cycle.record.explanation;
  std::vector<Vec2> plan;
  for (int i = 0; i < kTrajectoryPoints; i += kStepsShown) {
    plan.push_back(moved(cycle.record.plan.trajectory.points[i].rear_axle));
  }
  ordered_json json{{"kind", static_cast<int>(cycle.record.plan.kind)}, {"plan", units.steps(plan)}};

  ordered_json modes = ordered_json::array();
  for (const satp::AgentPrediction& agent : cycle.predictions) {
    const int car = agent.agent < cycle.tracks.size() ? car_of(cycle.tracks[agent.agent], now, origin) : -1;
    for (const satp::Mode& mode : agent.modes) {
      std::vector<Vec2> way;
      for (int i = kStepsShown - 1; i < kHorizonSteps; i += kStepsShown) way.push_back(moved(mode.steps[i]));
      modes.push_back(
          {car, std::lround(100.0F * mode.probability), mode.yields_percent >= 50 ? 1 : 0, units.steps(way)});
    }
  }
  json["modes"] = modes;
  if (!explains(cycle)) return json;

  const auto named = [&](std::uint8_t id) {
    const auto track =
        std::find_if(cycle.tracks.begin(), cycle.tracks.end(), [&](const Track& t) { return t.id == id; });
    return track != cycle.tracks.end() ? car_of(*track, now, origin) : -1;
  };
  json["risk"] = {peaks(cycle.risk.obstacle), peaks(cycle.risk.road), peaks(cycle.risk.social)};
  json["candidates"] = {e.candidate_count, rejected(e, trajectory::Rejection::kInfeasible),
                        rejected(e, trajectory::Rejection::kRefused)};
  json["cost"] = costs(e.chosen_cost);
  json["runner_up"] = costs(e.runner_up_cost);
  json["riskiest"] = named(e.dominating_track);
  json["numbers"] = in_numbers(cycle);
  json["blocked_by"] = named(e.blocking.track);
  return json;
}

}  // namespace

std::string changed(const campaign::EpisodeRow& recorded, const campaign::EpisodeRow& now) {
  const ordered_json then = campaign::to_json(recorded);
  const ordered_json again = campaign::to_json(now);
  std::string text;
  for (const auto& [key, value] : again.items()) {
    if (then.at(key) == value) continue;
    text += (text.empty() ? "" : "; ") + key + ": " + then.at(key).dump() + " then, " + value.dump() + " now";
  }
  return text;
}

ordered_json replay_data(const Replayed& episode) {
  const traffic::Recording& recording = episode.result.recording;
  const metrics::EpisodeMetrics& metrics = episode.row.metrics;
  const Vec2 origin = episode.result.origin;
  const Units units(origin);
  // Vehicle time starts with the pre-roll, the recording's time when the ECU takes over.
  const double pre_roll_s = -recording.snapshots.front().time_s;

  ordered_json data{{"who", campaign::words(episode.row.cell)},
                    {"seed", metrics.seed},
                    {"ending", metrics::ending_name(metrics.ending)},
                    {"cause", metrics.cause},
                    {"at_fault", metrics.collisions_at_fault > 0},
                    {"end_ms", thousandths(metrics.duration_s)},
                    {"unit_m", kUnitM},
                    {"horizon_ms", kHorizonSteps * kStepMs},
                    {"goal", units.of(recording.goal)},
                    {"road", road(episode.scenario.network, recording, units)},
                    {"haze_cell", std::lround(kHazeCellM / kUnitM)},
                    {"haze_columns", kHazeColumns}};
  std::map<int, std::array<long, 2>> sizes;
  ordered_json frames = ordered_json::array();
  for (const Snapshot& now : recording.snapshots) {
    if (now.time_s < kFirstShownS) continue;
    sizes[0] = {thousandths(now.ego.length_m), thousandths(now.ego.width_m)};
    for (const CarState& car : now.others) {
      sizes[car.id] = {thousandths(car.length_m), thousandths(car.width_m)};
    }
    frames.push_back(frame(now, origin, units));
  }
  ordered_json& sizes_mm = data["sizes_mm"] = ordered_json::object();
  for (const auto& [id, size] : sizes) sizes_mm[std::to_string(id)] = size;
  data["frames"] = std::move(frames);

  ordered_json cycles = ordered_json::array();
  if (episode.result.trace) {
    const std::vector<CycleTrace>& traced = episode.result.trace->cycles;
    const bool explained = std::any_of(traced.begin(), traced.end(), explains);
    const std::vector<ReasonSpan> story =
        explained ? reason_spans(*episode.result.trace, pre_roll_s) : std::vector<ReasonSpan>{};
    std::size_t told = 0;
    for (const CycleTrace& cycle : traced) {
      const double start_s = static_cast<double>(cycle.record.plan.start_ms) / 1000.0 - pre_roll_s;
      if (start_s < kFirstShownS) continue;
      const auto now = std::min_element(recording.snapshots.begin(), recording.snapshots.end(),
                                        [&](const Snapshot& a, const Snapshot& b) {
                                          return std::abs(a.time_s - start_s) < std::abs(b.time_s - start_s);
                                        });
      ordered_json one{{"t", thousandths(start_s)}};
      one.update(cycle_json(cycle, *now, origin, units));
      if (episode.row.cell.perception != "ideal") one["seen"] = seen(cycle.tracks, origin, units);
      if (told < story.size() && thousandths(story[told].from_s) <= thousandths(start_s)) {
        one["words"] = story[told++].words;  // they hold until others are said
      }
      cycles.push_back(std::move(one));
    }
    ordered_json& modes = data["ecu_modes"] = ordered_json::array();
    for (const ecu::ModeRecord& mode : episode.result.trace->modes) {
      modes.push_back({thousandths(mode.time_ms / 1000.0 - pre_roll_s), ecu::mode_name(mode.to)});
    }
  }
  data["cycles"] = std::move(cycles);
  ordered_json& contacts = data["contacts"] = ordered_json::array();
  for (const traffic::Collision& collision : recording.collisions) {
    contacts.push_back({{"t", thousandths(collision.time_s)},
                        {"car", collision.other},
                        {"cause", traffic::cause_words(collision.fault, collision.cause)}});
  }
  return data;
}

}  // namespace s4tp::view
