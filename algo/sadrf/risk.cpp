#include "algo/sadrf/risk.hpp"

#include "algo/core/inline.hpp"
#include "algo/sadrf/box_integral.hpp"
#include "algo/sadrf/field.hpp"
#include "algo/sadrf/futures.hpp"
#include "algo/sadrf/others_motion.hpp"
#include "algo/sadrf/road_risk.hpp"

namespace s4tp {
namespace {

/// A vehicle's box where our field is felt, with what it costs.
struct Felt {
  Box box;
  Point ahead;  ///< unit vector of the box's heading
  float probability = 0.0F;
  float risk = 0.0F;  ///< of the whole box, as if it were alone
  int agent = 0;
};

using FeltBoxes = BoundedVector<Felt, Futures::kCapacity>;

/// Risk of one step.
struct StepRisk {
  float obstacle = 0.0F;
  float social = 0.0F;
  float share[kMaxTracks] = {};  ///< per agent, both sides weighted as in the sum
};

float radius(const Track& track) {
  return 0.5F * (track.length_m + track.width_m);
}

bool inside(const Felt& felt, Point point) {
  const Point offset = point - position(felt.box.centre);
  return abs(dot(felt.ahead, offset)) <= 0.5F * felt.box.length_m &&
         abs(cross(felt.ahead, offset)) <= 0.5F * felt.box.width_m;
}

/// Sum over the modes of one vehicle that stand at `point`.
float presence(const FeltBoxes& felt, int agent, Point point) {
  float sum = 0.0F;
  for (const Felt& other : felt) {
    if (other.agent == agent && inside(other, point)) sum += other.probability;
  }
  return sum;
}

/// What part of a box's risk is its own: M is the largest presence of any vehicle, so that a vehicle pays
/// only for what it adds to those before it. 4 x 4 sub-samples, weighted by the field.
float own_part(const Field& field, const FeltBoxes& felt, int index) {
  const Felt& one = felt[index];
  const float reach_m = 0.5F * (one.box.length_m + one.box.width_m);
  bool alone = true;
  for (int i = 0; i < index && alone; ++i) {
    const Felt& other = felt[i];
    if (other.agent == one.agent) continue;
    const float both_m = reach_m + 0.5F * (other.box.length_m + other.box.width_m);
    const Point offset = position(other.box.centre) - position(one.box.centre);
    alone = dot(offset, offset) > square(both_m) || separation(one.box, other.box) > 0.0F;
  }
  if (alone) return 1.0F;
  constexpr int kSamples = 4;
  float own = 0.0F;
  float whole = 0.0F;
  for (int i = 0; i < kSamples * kSamples; ++i) {
    const int row = i / kSamples;
    const float ahead = (static_cast<float>(i % kSamples) + 0.5F) / static_cast<float>(kSamples) - 0.5F;
    const float left = (static_cast<float>(row) + 0.5F) / static_cast<float>(kSamples) - 0.5F;
    const Point to_left = {-one.ahead.y_m, one.ahead.x_m};
    const Point point = position(one.box.centre) + (ahead * one.box.length_m) * one.ahead +
                        (left * one.box.width_m) * to_left;
    const float weight = field_at(field, point);
    if (weight <= 0.0F) continue;
    float before = 0.0F;
    int agent = -1;
    for (int j = 0; j < index; ++j) {
      if (felt[j].agent == one.agent || felt[j].agent == agent) continue;
      agent = felt[j].agent;
      before = max(before, presence(felt, agent, point));
    }
    const float mine = presence(felt, one.agent, point);
    whole += weight;
    own += weight * max(mine - before, 0.0F) / max(mine, 1e-6F);
  }
  return whole > 0.0F ? own / whole : 1.0F;
}

/// R_ego of the vehicles: our field over their boxes.
void add_obstacles(const Scene& scene, const Futures& futures, const Field& field, int step,
                   const Parameters& parameters, FeltBoxes& felt, StepRisk& risk) {
  felt.clear();
  for (const Future& future : futures) {
    const Track& track = scene.agents[future.agent].track;
    const Pose& centre = future.mode->steps[step];
    if (out_of_reach(field, position(centre), radius(track))) continue;
    const Box box = {centre, track.length_m, track.width_m};
    const float cost = parameters.risk.cost_obstacle * future.probability;
    const float value = cost * field_over_box(field, box);
    if (value <= 0.0F) continue;
    if (!felt.push({box, direction(centre.heading_rad), future.probability, value, future.agent})) break;
  }
  for (int i = 0; i < felt.size(); ++i) {
    const float part = own_part(field, felt, i);
    risk.obstacle += part * felt[i].risk;
    risk.share[felt[i].agent] += part * felt[i].risk;
  }
}

/// True when we are surely behind a driver or further away than he looks: found from where he is and has come
/// to in `moved`, without a root.
bool unseen(Point moved, float look_ahead_per_moved, Point towards_us, float margin_m) {
  const float moved_squared = dot(moved, moved);
  const float distance_squared = dot(towards_us, towards_us);
  const float margin_squared = margin_m * margin_m;
  // (a + b)^2 <= 2 (a^2 + b^2)
  const float reach_squared = look_ahead_per_moved * look_ahead_per_moved * moved_squared + margin_squared;
  if (distance_squared > 2.0F * reach_squared) return true;
  constexpr float kTellsHeading = 0.09F;  // m^2: slower, and the motion does not tell the heading
  if (moved_squared < kTellsHeading) return false;
  // The motion of the box centre differs from the heading by 0.3 x length x kappa, a quarter of a radian or
  // so: what lies more than 108 degrees away from it is behind.
  const float ahead = dot(moved, towards_us);
  if (ahead >= 0.0F) return false;
  const float ahead_squared = ahead * ahead;
  return ahead_squared > margin_squared * moved_squared &&
         ahead_squared > 0.1F * distance_squared * moved_squared;
}

/// R_soc: their fields over our box.
void add_social(const Scene& scene, const Futures& futures, const Box& ego, int step, float look_ahead_s,
                const Parameters& parameters, StepRisk& risk) {
  const float ego_radius_m = 0.5F * (ego.length_m + ego.width_m);
  FieldParams params = field_params(parameters, parameters.vehicle.width_m);
  params.look_ahead_s = look_ahead_s;
  for (const Future& future : futures) {
    const Track& track = scene.agents[future.agent].track;
    const Pose& centre = future.mode->steps[step];
    const float margin_m = ego_radius_m + track.length_m + 1.0F;
    if (unseen(moved_at(*future.mode, step), look_ahead_s / kMotionWindowS,
               position(ego.centre) - position(centre), margin_m)) {
      continue;
    }
    const Motion motion = motion_at(*future.mode, step);
    params.base_width_m = 0.25F * track.width_m;
    const Field field = field_of_other(params, centre, motion, track.length_m);
    if (out_of_reach(field, position(ego.centre), ego_radius_m)) continue;
    const float cost = parameters.risk.cost_obstacle * future.probability;
    const float value = cost * field_over_box(field, ego);
    risk.social += value;
    risk.share[future.agent] += parameters.risk.weight_social * value;
  }
}

/// Both sides at step `step` + 1 of the trajectory.
/// \param felt  scratch, too large to be made anew at every step
StepRisk risk_at(const Scene& scene, const Futures& futures, const Trajectory& trajectory, int step,
                 const Parameters& parameters, FeltBoxes& felt) {
  const auto& vehicle = parameters.vehicle;
  const TrajectoryPoint& point = trajectory.points[step + 1];
  const float look_ahead_s =
      look_ahead_at(parameters.risk.look_ahead_s, parameters.risk.look_ahead_shrinks > 0.5F,
                    static_cast<float>(step + 1) * kStepS);
  FieldParams params = field_params(parameters, vehicle.width_m);
  params.look_ahead_s = look_ahead_s;
  const Point ahead = direction(point.rear_axle.heading_rad);
  const Field field = prepare_field(params, position(point.rear_axle), ahead, point.speed_mps,
                                    point.curvature_1pm, atan(vehicle.wheelbase_m * point.curvature_1pm));
  const Point centre =
      position(point.rear_axle) + (0.5F * vehicle.length_m - vehicle.rear_overhang_m) * ahead;
  const Box ego = {{centre.x_m, centre.y_m, point.rear_axle.heading_rad}, vehicle.length_m, vehicle.width_m};
  StepRisk risk;
  add_obstacles(scene, futures, field, step, parameters, felt, risk);
  add_social(scene, futures, ego, step, look_ahead_s, parameters, risk);
  return risk;
}

float instant(float obstacle, float road, float social, const Parameters& parameters) {
  return obstacle + road + parameters.risk.weight_social * social +
         parameters.scoring.risk_excess * max(obstacle - parameters.risk.threshold, 0.0F);
}

}  // namespace

float risk_integral(const RiskProfile& profile, const Parameters& parameters) {
  float sum = 0.0F;
  for (int i = 0; i < kHorizonSteps; ++i) {
    sum += instant(profile.obstacle[i], profile.road[i], profile.social[i], parameters);
  }
  return kStepS * sum;
}

void exact_risk(const Scene& scene, const DrivableArea& area, const PredictionSet& prediction,
                const KinematicSet& others, const Trajectory& trajectory, const Parameters& parameters,
                RiskProfile& profile) {
  const Futures futures = all_modes(scene, prediction, others);
  road_risk(area, trajectory, parameters, 1, 1, profile.road);
  profile.dominating_agent = 255;
  profile.dominating_step = 0;
  float largest = 0.0F;
  FeltBoxes felt;
  for (int i = 0; i < kHorizonSteps; ++i) {
    const StepRisk risk = risk_at(scene, futures, trajectory, i, parameters, felt);
    profile.obstacle[i] = risk.obstacle;
    profile.social[i] = risk.social;
    for (int agent = 0; agent < scene.agents.size(); ++agent) {
      if (risk.share[agent] <= largest) continue;
      largest = risk.share[agent];
      profile.dominating_agent = static_cast<std::uint8_t>(agent);
      profile.dominating_step = static_cast<std::uint8_t>(i);
    }
  }
}

float rank_risk(const Scene& scene, const DrivableArea& area, const PredictionSet& prediction,
                const KinematicSet& others, const Trajectory& trajectory, const Parameters& parameters) {
  constexpr int kStride = 3;
  constexpr int kMiddle = 1;  // of three steps: their sum is three times it to first order
  const Futures futures = likeliest(all_modes(scene, prediction, others));
  float road[kHorizonSteps] = {};
  road_risk(area, trajectory, parameters, kMiddle + 1, kStride, road);
  FeltBoxes felt;
  float sum = 0.0F;
  for (int i = kMiddle; i < kHorizonSteps; i += kStride) {
    const StepRisk risk = risk_at(scene, futures, trajectory, i, parameters, felt);
    sum += instant(risk.obstacle, road[i], risk.social, parameters);
  }
  return static_cast<float>(kStride) * kStepS * sum;
}

}  // namespace s4tp
