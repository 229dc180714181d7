#include "algo/trajectory/clearance.hpp"

#include "algo/core/inline.hpp"
#include "algo/trajectory/bicycle.hpp"

namespace s4tp::trajectory {
namespace {

constexpr int kConstantVelocitySteps = 15;  // as the check: longer nobody keeps its velocity
constexpr float kOverMarginM = 0.02F;       // kept beyond the check's margin: rounding

/// A box with what its supports need.
struct Shape {
  Point centre;
  Point ahead;
  Point left;
  float half_length_m;
  float half_width_m;
};

Shape shape_of(const Box& box) {
  const Point ahead = direction(box.centre.heading_rad);
  return {position(box.centre), ahead, {-ahead.y_m, ahead.x_m}, 0.5F * box.length_m, 0.5F * box.width_m};
}

float support(const Shape& shape, Point normal) {
  return shape.half_length_m * abs(dot(shape.ahead, normal)) +
         shape.half_width_m * abs(dot(shape.left, normal));
}

/// Their separating axis of largest gap, from `other` to `own`.
float widest_gap(const Shape& own, const Shape& other, Point& normal) {
  const Point apart = own.centre - other.centre;
  const Point axes[] = {own.ahead, own.left, other.ahead, other.left};
  float widest_m = -1e9F;
  for (const Point& axis : axes) {
    const float along_m = dot(axis, apart);
    const float gap_m = abs(along_m) - support(own, axis) - support(other, axis);
    if (gap_m <= widest_m) continue;
    widest_m = gap_m;
    normal = along_m < 0.0F ? -1.0F * axis : axis;
  }
  return widest_m;
}

/// The nearest half-plane of one vehicle at one step.
struct Nearest {
  float gap_m;
  HalfPlane plane;
};

void look_at(const Shape& own, const Pose& centre, const Track& track, Nearest& nearest) {
  const float around_m = own.half_length_m + own.half_width_m + 0.5F * (track.length_m + track.width_m);
  const Point apart = own.centre - position(centre);
  if (dot(apart, apart) > square(around_m + nearest.gap_m)) return;
  const Shape other = shape_of({centre, track.length_m, track.width_m});
  Point normal;
  const float gap_m = widest_gap(own, other, normal);
  if (gap_m <= 0.0F || gap_m >= nearest.gap_m) return;
  nearest.gap_m = gap_m;
  nearest.plane = {normal.x_m, normal.y_m, dot(normal, other.centre) + support(other, normal), 0.0F};
}

/// Keeps the kMaxHalfPlanes nearest, nearest first.
void insert(const Nearest& nearest, RefinementStep& step, float (&gaps_m)[kMaxHalfPlanes]) {
  int i = step.half_plane_count;
  if (i == kMaxHalfPlanes) {
    if (nearest.gap_m >= gaps_m[i - 1]) return;
    --i;
  } else {
    ++step.half_plane_count;
  }
  for (; i > 0 && nearest.gap_m < gaps_m[i - 1]; --i) {
    gaps_m[i] = gaps_m[i - 1];
    step.half_planes[i] = step.half_planes[i - 1];
  }
  gaps_m[i] = nearest.gap_m;
  step.half_planes[i] = nearest.plane;
}

void look_at(const Shape& own, const satp::PredictionSet& prediction, int agent, int index,
             const Track& track, Nearest& nearest) {
  for (const satp::AgentPrediction& predicted : prediction.agents) {
    if (predicted.agent != agent) continue;
    for (const satp::Mode& mode : predicted.modes) look_at(own, mode.steps[index], track, nearest);
  }
}

}  // namespace

void find_half_planes(const Surroundings& surroundings, const Trajectory& trajectory, Point origin,
                      float reach_m, const Parameters& parameters, RefinementProblem& problem) {
  const scene::Scene& scene = surroundings.scene;
  const float margin_m = parameters.safety.margin_m + kOverMarginM;
  for (int i = 0; i < kHorizonSteps; ++i) {
    RefinementStep& step = problem.steps[i];
    step.half_plane_count = 0;
    float gaps_m[kMaxHalfPlanes] = {};
    const Shape own = shape_of(ego_box(trajectory.points[i + 1].rear_axle, parameters));
    for (int agent = 0; agent < scene.agents.size(); ++agent) {
      const Track& track = scene.agents[agent].track;
      Nearest nearest{reach_m, {}};
      look_at(own, surroundings.marginal, agent, i, track, nearest);
      look_at(own, surroundings.conditioned, agent, i, track, nearest);
      if (i < kConstantVelocitySteps && agent < surroundings.constant_velocity.agents.size()) {
        look_at(own, surroundings.constant_velocity.agents[agent].steps[i], track, nearest);
      }
      if (nearest.gap_m >= reach_m) continue;
      nearest.plane.offset_m -= nearest.plane.normal_x * origin.x_m + nearest.plane.normal_y * origin.y_m;
      nearest.plane.least_gap_m = min(margin_m, nearest.gap_m);
      insert(nearest, step, gaps_m);
    }
  }
}

}  // namespace s4tp::trajectory
