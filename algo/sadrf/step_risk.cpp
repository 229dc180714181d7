#include "algo/sadrf/step_risk.hpp"

#include "algo/core/inline.hpp"
#include "algo/sadrf/box_integral.hpp"
#include "algo/sadrf/others_motion.hpp"

namespace s4tp::sadrf {
namespace {

/// Below, a fifth of a risk off (the worst of two lines) is nothing beside a threshold of many thousands.
constexpr float kTiny = 1e-6F;  // no division by less
constexpr float kWorthSlices = 200.0F;
constexpr float kWorthSlope = 20.0F;  // for a second, a hundredth of a metre of progress

// Work (WorkMeter's units).
constexpr std::int32_t kStepWork = 8;        // our field and box
constexpr std::int32_t kFutureWork = 2;      // to see that it is out of reach on both sides
constexpr std::int32_t kLinesWork = 9;       // a field over a box by lines
constexpr std::int32_t kTheirFieldWork = 4;  // to make another's field
constexpr std::int32_t kSliceWork = 6;       // a field over a slice of a box
constexpr std::int32_t kMostSlicesWork = kSliceWork * kMaxSlices;
constexpr std::int32_t kSlopeWork = 16;  // the same with its slopes
constexpr std::int32_t kMostSlopesWork = kSlopeWork * kMaxSlices;
/// For a box among so many, by its centre.
constexpr std::int32_t centre_work(int boxes) {
  return 1 + boxes;
}
constexpr std::int32_t kPairWork = 1;          // whether two boxes share ground
constexpr std::int32_t kSamplesWork = 40;      // our field at the samples of a box
constexpr std::int32_t kPairSamplesWork = 13;  // whether another box covers them

float radius(float length_m, float width_m) {
  return 0.5F * (length_m + width_m);
}

/// \param ahead  unit vector of the box's heading
float risk_of_box(const Field& field, const Box& box, Point ahead, float cost, Precision precision,
                  WorkMeter& work) {
  work.spend(kLinesWork);
  const float risk = cost * field_over_box(field, box, ahead);
  if (precision == Precision::kLines || risk < kWorthSlices || !work.allows(kMostSlicesWork)) return risk;
  int lines = 0;
  const float precise = cost * field_over_slices(field, box, lines);
  work.spend(kSliceWork * lines);
  return precise;
}

/// Our driver at step `step` + 1.
struct Driver {
  FieldParams params;
  Field field;  ///< field.ahead is the heading of the box, too
  float steering_rad;
  Box box;
};

Driver driver_at(const StepInputs& inputs, int step) {
  const auto& vehicle = inputs.parameters.vehicle;
  const TrajectoryPoint& point = inputs.trajectory.points[step + 1];
  Driver driver;
  driver.params = inputs.params;
  driver.params.look_ahead_s =
      look_ahead_at(inputs.parameters.risk.look_ahead_s, inputs.parameters.risk.look_ahead_shrinks > 0.5F,
                    static_cast<float>(step + 1) * kStepS);
  const Point ahead = direction(point.rear_axle.heading_rad);
  driver.steering_rad = atan(vehicle.wheelbase_m * point.curvature_1pm);
  driver.field = prepare_field(driver.params, position(point.rear_axle), ahead, point.speed_mps,
                               point.curvature_1pm, driver.steering_rad);
  const Point centre =
      position(point.rear_axle) + (0.5F * vehicle.length_m - vehicle.rear_overhang_m) * ahead;
  driver.box = {{centre.x_m, centre.y_m, point.rear_axle.heading_rad}, vehicle.length_m, vehicle.width_m};
  return driver;
}

using Indices = BoundedVector<std::uint8_t, CostBoxes::kCapacity>;

/// Sum of those boxes' costs that the point lies in. \param from  first of a run of `indices` of one agent
/// \return where the next agent's run begins
int add_run(const CostBoxes& boxes, const Indices& indices, int from, Point point, float& cost) {
  const int agent = boxes[indices[from]].agent;
  int i = from;
  for (; i < indices.size() && boxes[indices[i]].agent == agent; ++i) {
    if (covers(boxes[indices[i]], point)) cost += boxes[indices[i]].cost;
  }
  return i;
}

/// What part of a box's risk is its own (own_part()), by what is at its centre alone.
float own_part_at_centre(const CostBoxes& boxes, int index) {
  const CostBox& one = boxes[index];
  float others = 0.0F;
  float mine = 0.0F;
  for (int i = 0; i < boxes.size();) {
    const int agent = boxes[i].agent;
    float cost = 0.0F;
    for (; i < boxes.size() && boxes[i].agent == agent; ++i) {
      if (covers(boxes[i], position(one.box.centre))) cost += boxes[i].cost;
    }
    if (agent < one.agent) others = max(others, cost);
    if (agent == one.agent) mine = cost;
    if (agent >= one.agent) break;
  }
  return max(mine - others, 0.0F) / max(mine, kTiny);
}

/// What part of a box's risk is its own: M is the largest of any vehicle's, so that a vehicle pays only for
/// what it adds to those before it. 4 x 4 sub-samples, weighted by the field; by its centre where there is no work left.
float own_part(const Field& field, const CostBoxes& boxes, int index, WorkMeter& work) {
  if (index == 0 || boxes[index].agent == boxes[0].agent) return 1.0F;  // nobody before it
  if (!work.allows(kSamplesWork + (kPairWork + kPairSamplesWork) * boxes.size())) {
    work.spend(centre_work(boxes.size()));
    return own_part_at_centre(boxes, index);
  }
  work.spend(kPairWork * boxes.size());
  const CostBox& one = boxes[index];
  const float reach_m = radius(one.box.length_m, one.box.width_m);
  Indices before;  // of other vehicles, on some of the same ground
  Indices same;    // of this vehicle
  for (int i = 0; i < boxes.size(); ++i) {
    const CostBox& other = boxes[i];
    if (other.agent == one.agent) {
      (void)same.push(static_cast<std::uint8_t>(i));
      continue;
    }
    if (i > index) continue;
    const float both_m = reach_m + radius(other.box.length_m, other.box.width_m);
    const Point offset = position(other.box.centre) - position(one.box.centre);
    if (dot(offset, offset) > square(both_m) || separation(one.box, one.ahead, other.box, other.ahead) > 0.0F)
      continue;
    (void)before.push(static_cast<std::uint8_t>(i));
  }
  if (before.empty()) return 1.0F;
  work.spend(kSamplesWork + kPairSamplesWork * (before.size() + same.size()));
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
    float others = 0.0F;
    for (int j = 0; j < before.size();) {
      float cost = 0.0F;
      j = add_run(boxes, before, j, point, cost);
      others = max(others, cost);
    }
    float mine = 0.0F;
    (void)add_run(boxes, same, 0, point, mine);
    whole += weight;
    own += weight * max(mine - others, 0.0F) / max(mine, kTiny);
  }
  return whole > 0.0F ? own / whole : 1.0F;
}

/// R_ego of the vehicles: our field over their boxes. Calls each(field, box, part of it that counts, risk).
template <typename Each>
void for_boxes_in_our_field(const StepInputs& inputs, const Field& field, int step, CostBoxes& boxes,
                            WorkMeter& work, const Each& each) {
  boxes.clear();
  float risks[CostBoxes::kCapacity];
  for (const Future& future : inputs.futures) {
    const Track& track = *future.track;
    const Pose& centre = future.mode->steps[step];
    if (out_of_reach(field, position(centre), radius(track.length_m, track.width_m))) continue;
    const Box box = {centre, track.length_m, track.width_m};
    const Point ahead = direction(centre.heading_rad);
    const float cost =
        inputs.parameters.risk.cost_obstacle * future.probability * inputs.modulation[future.agent];
    const float risk = risk_of_box(field, box, ahead, cost, inputs.precision, work);
    if (risk <= 0.0F) continue;
    risks[boxes.size()] = risk;
    if (!boxes.push({box, ahead, cost, future.agent})) break;
  }
  for (int i = 0; i < boxes.size(); ++i) each(boxes[i], own_part(field, boxes, i, work), risks[i]);
}

/// True when we are surely behind a driver or beyond its look-ahead distance: found from where it is and has
/// come to in `moved`, without a root.
bool unseen(Point moved, float look_ahead_per_moved, Point towards_us, float margin_m) {
  const float moved_squared = dot(moved, moved);
  const float distance_squared = dot(towards_us, towards_us);
  const float margin_squared = margin_m * margin_m;
  // (a + b)^2 <= 2 (a^2 + b^2)
  const float reach_squared = look_ahead_per_moved * look_ahead_per_moved * moved_squared + margin_squared;
  if (distance_squared > 2.0F * reach_squared) return true;
  constexpr float kBehind = 0.1F;         // square of the cosine of 108 degrees
  constexpr float kTellsHeading = 0.09F;  // m^2: slower, and the motion does not tell the heading
  if (moved_squared < kTellsHeading) return false;
  // The motion of the box centre differs from the heading by 0.3 x length x kappa, a quarter of a radian or
  // so: what lies more than 108 degrees away from it is behind.
  const float ahead = dot(moved, towards_us);
  if (ahead >= 0.0F) return false;
  const float ahead_squared = ahead * ahead;
  return ahead_squared > margin_squared * moved_squared &&
         ahead_squared > kBehind * distance_squared * moved_squared;
}

/// R_soc: their fields over our box. Calls each(future, their field, how it was made, cost).
template <typename Each>
void for_fields_on_us(const StepInputs& inputs, const Driver& driver, int step, WorkMeter& work,
                      const Each& each) {
  const Box& ego = driver.box;
  const float ego_radius_m = radius(ego.length_m, ego.width_m);
  const float look_ahead_per_moved = driver.params.look_ahead_s / kMotionWindowS;
  FieldParams params = driver.params;
  for (const Future& future : inputs.futures) {
    const Track& track = *future.track;
    const Pose& centre = future.mode->steps[step];
    const float margin_m = ego_radius_m + track.length_m + 1.0F;
    const Point moved = moved_at(*future.mode, step);
    if (unseen(moved, look_ahead_per_moved, position(ego.centre) - position(centre), margin_m)) continue;
    work.spend(kTheirFieldWork);
    const RecentMotion motion = motion_at(*future.mode, step, moved);
    params.base_width_m = 0.25F * track.width_m;
    const Field field = field_of_other(params, centre, motion, track.length_m);
    if (out_of_reach(field, position(ego.centre), ego_radius_m)) continue;
    each(future, field, inputs.parameters.risk.cost_obstacle * future.probability);
  }
}

void add(const FieldGradient& from, float weight, FieldGradient& to) {
  to.x += weight * from.x;
  to.y += weight * from.y;
  to.heading += weight * from.heading;
  to.speed += weight * from.speed;
  to.steering += weight * from.steering;
}

/// To move a box in a field is to move the field the other way; our box turns about our rear axle.
FieldGradient by_the_box(const FieldGradient& by_field, Point field_origin, Point axle) {
  const Point arm = field_origin - axle;
  return {-by_field.x, -by_field.y, -(by_field.heading - by_field.x * arm.y_m + by_field.y * arm.x_m), 0.0F,
          0.0F};
}

}  // namespace

StepInputs step_inputs(const scene::Scene& scene, const Futures& futures, const Trajectory& trajectory,
                       const Parameters& parameters, Precision precision) {
  const FieldParams params = field_params(parameters, parameters.vehicle.width_m);
  StepInputs inputs = {scene, futures, trajectory, parameters, precision, params, {}};
  for (int i = 0; i < scene.agents.size(); ++i) {
    inputs.modulation[i] = modulation(scene.ego, scene.agents[i].track, parameters);
  }
  return inputs;
}

std::int32_t least_work(int futures) {
  return kStepWork + (kFutureWork + kTheirFieldWork + 2 * kLinesWork + centre_work(futures)) * futures;
}

StepRisk risk_at(const StepInputs& inputs, int step, CostBoxes& boxes, WorkMeter& work) {
  const Driver driver = driver_at(inputs, step);
  work.spend(kStepWork + kFutureWork * inputs.futures.size());
  StepRisk risk;
  for (int i = 0; i < inputs.scene.agents.size(); ++i) risk.share[i] = 0.0F;
  const auto add_box = [&](const CostBox& one, float part, float whole) {
    risk.obstacle += part * whole;
    risk.share[one.agent] += part * whole;
  };
  for_boxes_in_our_field(inputs, driver.field, step, boxes, work, add_box);
  for_fields_on_us(inputs, driver, step, work, [&](const Future& future, const Field& field, float cost) {
    const float value = risk_of_box(field, driver.box, driver.field.ahead, cost, inputs.precision, work);
    risk.social += value;
    risk.share[future.agent] += inputs.parameters.risk.weight_social * value;
  });
  return risk;
}

StepSlope slope_at(const StepInputs& inputs, int step, CostBoxes& boxes, WorkMeter& work) {
  const Driver driver = driver_at(inputs, step);
  const TrajectoryPoint& point = inputs.trajectory.points[step + 1];
  const FieldSlopes slopes = field_slopes(driver.params, point.speed_mps, point.curvature_1pm,
                                          driver.steering_rad, inputs.parameters.vehicle.wheelbase_m);
  work.spend(kStepWork + kFutureWork * inputs.futures.size());
  StepSlope slope;
  int lines = 0;
  const auto add_box = [&](const CostBox& one, float part, float whole) {
    if (whole < kWorthSlope || !work.allows(kMostSlopesWork)) {
      slope.obstacle_risk += part * whole;
      return;
    }
    FieldGradient gradient;
    slope.obstacle_risk +=
        part * one.cost * field_over_slices(driver.field, one.box, slopes, gradient, lines);
    work.spend(kSlopeWork * lines);
    add(gradient, part * one.cost, slope.obstacle);
  };
  for_boxes_in_our_field(inputs, driver.field, step, boxes, work, add_box);
  for_fields_on_us(inputs, driver, step, work, [&](const Future&, const Field& field, float cost) {
    if (!work.allows(kMostSlopesWork)) {
      slope.social_risk += risk_of_box(field, driver.box, driver.field.ahead, cost, inputs.precision, work);
      return;
    }
    FieldGradient gradient;
    const float value = cost * field_over_slices(field, driver.box, {}, gradient, lines);
    work.spend(kSlopeWork * lines);
    slope.social_risk += value;
    if (value < kWorthSlope) return;
    add(by_the_box(gradient, field.origin, position(point.rear_axle)), cost, slope.social);
  });
  return slope;
}

}  // namespace s4tp::sadrf
