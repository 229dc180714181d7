#include "sim_host/baselines/drf_controller.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "algo/core/math.hpp"
#include "algo/sadrf/box_integral.hpp"
#include "algo/trajectory/bicycle.hpp"
#include "algo/trajectory/candidates.hpp"
#include "sim_host/baselines/planner_registry.hpp"

namespace s4tp::baselines {
namespace {

const RegisterPlanner kRegistered{
    planner<DrfControllerPlanner>("drf_controller", "Kolekar's four-case controller on the risk field")};

constexpr int kGrid = 12;  // of the search, then halved so often between two points of it:
constexpr int kHalvings = 6;
constexpr float kAimS = 1.0F;           // heading control aims at the lane's centre so far ahead
constexpr float kAimM = 5.0F;           // and no nearer
constexpr float kLookS = 0.6F;          // v_des is that of here and of so far ahead
constexpr int kLawSteps = 5;            // the law decides every so many steps of the plan
constexpr float kDriveStepMps2 = 0.8F;  // change of acceleration in a step
constexpr float kBrakeStepMps2 = 2.0F;
constexpr int kAlong = 24;  // sample points of the road's risk
constexpr int kAcross = 13;
constexpr float kAcrossSigma = 3.0F;

/// The lane beside ours when that brings us nearer to the route's, else ours.
const scene::EgoPath& wanted_path(const scene::Scene& scene) {
  return *std::min_element(scene.ego_paths.begin(), scene.ego_paths.end(),
                           [](const scene::EgoPath& a, const scene::EgoPath& b) {
                             return std::abs(a.changes_needed) < std::abs(b.changes_needed);
                           });
}

}  // namespace

DrfCommand drf_command(const DrfLaw& law, const std::function<float(float)>& risk, float heading_rad,
                       float low_rad, float high_rad, float speed_mps, float desired_mps) {
  const float to_desired =
      std::clamp(law.speed_gain_1ps * (desired_mps - speed_mps), -law.braking_mps2, law.acceleration_mps2);
  const bool too_fast = speed_mps > desired_mps;
  if (risk(heading_rad) <= law.threshold) return {too_fast ? 3 : 1, heading_rad, to_desired};

  // Least risk: the best of a grid, then of ever finer neighbours.
  const float spacing = (high_rad - low_rad) / static_cast<float>(kGrid);
  float least_rad = std::clamp(heading_rad, low_rad, high_rad);
  float least = risk(least_rad);
  const auto try_at = [&](float steering_rad) {
    const float here = risk(std::clamp(steering_rad, low_rad, high_rad));
    if (here >= least) return;
    least = here;
    least_rad = std::clamp(steering_rad, low_rad, high_rad);
  };
  for (int i = 0; i <= kGrid; ++i) try_at(low_rad + spacing * static_cast<float>(i));
  float step = 0.5F * spacing;
  for (int i = 0; i < kHalvings; ++i, step *= 0.5F) {
    const float middle = least_rad;
    try_at(middle - step);
    try_at(middle + step);
  }

  const float slow =
      -std::min(law.braking_mps2 * std::max(0.0F, least / law.threshold - 1.0F), law.braking_max_mps2);
  if (too_fast) return {4, least_rad, std::min(slow, to_desired)};
  if (least > law.threshold) return {2, least_rad, slow};
  // Between the heading control's steering, over C_t, and the least: where risk is just C_t.
  float over = heading_rad;
  float under = least_rad;
  for (int i = 0; i < kHalvings; ++i) {
    const float middle = 0.5F * (over + under);
    (risk(middle) > law.threshold ? over : under) = middle;
  }
  return {2, under, 0.0F};
}

Status DrfControllerPlanner::init(const Parameters& parameters) {
  int first_bad = 0;
  parameters_ = parameters;
  scene_builder_.reset();
  return validate(parameters, first_bad);
}

Status DrfControllerPlanner::plan(const planner::PlannerInput& input, Plan& plan,
                                  planner::Explanation& explanation) {
  explanation = planner::Explanation{};
  const Plan running = input.running != nullptr ? *input.running : Plan{};
  const Status status = scene_builder_.build(input.now_ms, input.ego, input.tracks, input.tracks_ms,
                                             input.map, parameters_, scene_);
  explanation.status = status;
  TrajectoryPoint state =
      trajectory::plan_start(input.ego, input.now_ms, running, input.start_ms, parameters_);
  plan.start_ms = input.start_ms;
  plan.kind = PlanKind::kDrive;
  plan.trajectory.points[0] = state;
  has_road_ = status == Status::kOk;
  sadrf::build_drivable(has_road_ ? input.map : nullptr, area_);
  const Point half{0.5F * kGroundCells * kGroundCellM, 0.5F * kGroundCells * kGroundCellM};
  ground_corner_ = offset_point(state.rear_axle, 0.75F * half.x_m, 0.0F) - half;
  std::memset(ground_, -1, sizeof(ground_));
  float s_m = 0.0F;
  if (has_road_) {
    const scene::EgoPath& path = wanted_path(scene_);
    s_m = scene::project(*input.map, path.path, position(state.rear_axle), path.frenet.s_m, 20.0F).s_m;
    trajectory::build_reference(*input.map, path.path, s_m, state.speed_mps, parameters_, line_);
  }

  const auto& vehicle = parameters_.vehicle;
  DrfCommand command;
  for (int i = 1; i < kTrajectoryPoints; ++i) {
    if ((i - 1) % kLawSteps == 0) command = command_at(state, s_m);
    const float steering_rad = trajectory::steering_for(state.curvature_1pm, vehicle.wheelbase_m);
    const float step_rad = vehicle.steering_rate_max_radps * kStepS;
    const float next_rad = std::clamp(command.steering_rad, steering_rad - step_rad, steering_rad + step_rad);
    const float rate_1pms =
        (trajectory::curvature_for(next_rad, vehicle.wheelbase_m) - state.curvature_1pm) / kStepS;
    const float acceleration = std::clamp(command.acceleration_mps2, state.acceleration_mps2 - kBrakeStepMps2,
                                          state.acceleration_mps2 + kDriveStepMps2);
    const float before_mps = state.speed_mps;
    const bool rests = before_mps <= 0.0F && acceleration <= 0.0F;
    state = trajectory::bicycle_step(state, acceleration, rests ? 0.0F : rate_1pms, kStepS);
    s_m += 0.5F * kStepS * (before_mps + state.speed_mps);
    plan.trajectory.points[i] = state;
  }
  return status;
}

DrfCommand DrfControllerPlanner::command_at(const TrajectoryPoint& state, float guess_s_m) const {
  const auto& vehicle = parameters_.vehicle;
  const float speed_mps = state.speed_mps;
  // What lateral acceleration and the wheels allow.
  const float bend_1pm = parameters_.comfort.lateral_mps2 / std::max(speed_mps * speed_mps, 1.0F);
  const float most_rad =
      std::min(trajectory::steering_for(bend_1pm, vehicle.wheelbase_m), vehicle.steering_max_rad);
  float heading_rad = 0.0F;
  float desired_mps = std::min(law.desired_mps, std::max(speed_mps, 1.0F));
  if (has_road_) {
    const trajectory::ReferenceCoordinates where =
        trajectory::locate_on(line_, position(state.rear_axle), guess_s_m);
    const float ahead_m = std::max(kAimS * speed_mps, kAimM);
    const Point aim =
        to_local(state.rear_axle, position(trajectory::reference_at(line_, where.s_m + ahead_m).pose));
    heading_rad =
        trajectory::steering_for(2.0F * aim.y_m / std::max(dot(aim, aim), 1.0F), vehicle.wheelbase_m);
    desired_mps = std::min({law.desired_mps, trajectory::reference_at(line_, where.s_m).speed_cap_mps,
                            trajectory::reference_at(line_, where.s_m + kLookS * speed_mps).speed_cap_mps});
  }
  return drf_command(
      law, [&](float steering_rad) { return risk_of(state, steering_rad); },
      std::clamp(heading_rad, -most_rad, most_rad), -most_rad, most_rad, speed_mps, desired_mps);
}

float DrfControllerPlanner::risk_of(const TrajectoryPoint& state, float steering_rad) const {
  const auto& vehicle = parameters_.vehicle;
  const sadrf::Field field =
      sadrf::prepare_field(sadrf::kolekar2020_preset(vehicle.width_m),
                           {state.rear_axle, state.speed_mps, steering_rad, vehicle.wheelbase_m});
  float obstacles = 0.0F;
  for (const scene::Agent& agent : scene_.agents) {
    const Track& track = agent.track;
    obstacles += sadrf::field_over_box(field, {track.centre, track.length_m, track.width_m});
  }
  return parameters_.risk.cost_obstacle * obstacles + road_risk(field);
}

float DrfControllerPlanner::road_risk(const sadrf::Field& field) const {
  if (area_.map == nullptr) return 0.0F;
  // Samples along and across the field's path, an arc from the rear axle.
  const float reach_m = std::min(field.look_ahead_m, kPi / std::max(std::abs(field.curvature_1pm), 1e-3F));
  const float along_m = reach_m / kAlong;
  const Point left{-field.ahead.y_m, field.ahead.x_m};
  float sum = 0.0F;
  for (int i = 0; i < kAlong; ++i) {
    const float s_m = (static_cast<float>(i) + 0.5F) * along_m;
    const float turned_rad = field.curvature_1pm * s_m;
    const float low_m = -kAcrossSigma * (field.base_width_m + field.widening_right * s_m);
    const float high_m = kAcrossSigma * (field.base_width_m + field.widening_left * s_m);
    const float across_m = (high_m - low_m) / kAcross;
    // The chord leaves at half the angle turned.
    const float half_rad = 0.5F * turned_rad;
    const float chord_m = s_m * (std::abs(half_rad) < 1e-3F ? 1.0F : std::sin(half_rad) / half_rad);
    const Point at = field.origin + chord_m * (std::cos(half_rad) * field.ahead + std::sin(half_rad) * left);
    const Point side = std::cos(turned_rad) * left - std::sin(turned_rad) * field.ahead;
    for (int k = 0; k < kAcross; ++k) {
      const float e_m = low_m + (static_cast<float>(k) + 0.5F) * across_m;
      const Point point = at + e_m * side;
      const sadrf::Ground below = ground(point);
      if (below == sadrf::Ground::kOurs) continue;
      const float cost =
          below == sadrf::Ground::kOffRoad ? parameters_.risk.cost_off_road : parameters_.risk.cost_opposite;
      const float area_m2 = along_m * across_m * std::max(0.0F, 1.0F - field.curvature_1pm * e_m);
      sum += cost * sadrf::field_at(field, point) * area_m2;
    }
  }
  return sum;
}

sadrf::Ground DrfControllerPlanner::ground(Point point) const {
  const float column = (point.x_m - ground_corner_.x_m) / kGroundCellM;
  const float row = (point.y_m - ground_corner_.y_m) / kGroundCellM;
  if (!(column >= 0.0F && row >= 0.0F && column < kGroundCells && row < kGroundCells))
    return sadrf::ground_at(area_, point);
  std::int8_t& cell = ground_[static_cast<int>(row)][static_cast<int>(column)];
  if (cell < 0) {
    const Point middle = ground_corner_ + Point{(std::floor(column) + 0.5F) * kGroundCellM,
                                                (std::floor(row) + 0.5F) * kGroundCellM};
    cell = static_cast<std::int8_t>(sadrf::ground_at(area_, middle));
  }
  return static_cast<sadrf::Ground>(cell);
}

}  // namespace s4tp::baselines
