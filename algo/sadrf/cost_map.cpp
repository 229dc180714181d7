#include "algo/sadrf/cost_map.hpp"

#include "algo/core/inline.hpp"

namespace s4tp::sadrf {

bool covers(const CostBox& one, Point point) {
  const Point offset = point - position(one.box.centre);
  return abs(dot(one.ahead, offset)) <= 0.5F * one.box.length_m &&
         abs(cross(one.ahead, offset)) <= 0.5F * one.box.width_m;
}

float modulation(const EgoState& ego, const Track& track, const Parameters& parameters) {
  constexpr float kNearM = 20.0F;
  constexpr float kFastMps = 10.0F;
  constexpr float kClosestM = 0.1F;
  const auto& risk = parameters.risk;
  if (risk.nearness == 0.0F && risk.closing == 0.0F) return 1.0F;
  const float to_centre_m = 0.5F * parameters.vehicle.length_m - parameters.vehicle.rear_overhang_m;
  const Point offset = position(track.centre) - position(shift_ahead(ego.rear_axle, to_centre_m));
  const float distance_m = max(norm(offset), kClosestM);
  const Point velocity = track.speed_mps * direction(track.centre.heading_rad) -
                         ego.speed_mps * direction(ego.rear_axle.heading_rad);
  const float closing_mps = max(-dot(velocity, offset) / distance_m, 0.0F);
  return 1.0F + risk.nearness * exp(-distance_m / kNearM) + risk.closing * closing_mps / kFastMps;
}

void place_obstacles(const scene::Scene& scene, const Futures& futures, int step,
                     const Parameters& parameters, CostBoxes& boxes) {
  boxes.clear();
  for (const Future& future : futures) {
    const Track& track = scene.agents[future.agent].track;
    const Pose& centre = future.mode->steps[step];
    const float cost =
        parameters.risk.cost_obstacle * future.probability * modulation(scene.ego, track, parameters);
    const Box box = {centre, track.length_m, track.width_m};
    if (!boxes.push({box, direction(centre.heading_rad), cost, future.agent})) break;
  }
}

float cost_of(const CostBoxes& boxes, int agent, Point point) {
  float sum = 0.0F;
  for (const CostBox& one : boxes) {
    if (one.agent == agent && covers(one, point)) sum += one.cost;
  }
  return sum;
}

float obstacle_cost(const CostBoxes& boxes, Point point) {
  float largest = 0.0F;
  int agent = -1;
  for (const CostBox& one : boxes) {
    if (one.agent == agent) continue;
    agent = one.agent;
    largest = max(largest, cost_of(boxes, agent, point));
  }
  return largest;
}

float obstacle_cost(const CostBoxes& boxes, const Pose& cell, float side_m) {
  constexpr int kSamples = 4;
  const Point ahead = (side_m / float{kSamples}) * direction(cell.heading_rad);
  const Point left = {-ahead.y_m, ahead.x_m};
  constexpr float kFirst = 0.5F * float{kSamples - 1};
  float sum = 0.0F;
  for (int i = 0; i < kSamples; ++i) {
    for (int j = 0; j < kSamples; ++j) {
      const Point along = (static_cast<float>(i) - kFirst) * ahead;
      const Point across = (static_cast<float>(j) - kFirst) * left;
      sum += obstacle_cost(boxes, position(cell) + along + across);
    }
  }
  return sum / float{kSamples * kSamples};
}

float cell_risk(const Field& field, const CostBoxes& boxes, const Pose& cell, float side_m) {
  const float density = field_at(field, position(cell));
  return density > 0.0F ? density * obstacle_cost(boxes, cell, side_m) * square(side_m) : 0.0F;
}

}  // namespace s4tp::sadrf
