#pragma once
/// Candidates on random roads with vehicles about, as the optimizer gets them.

#include <cmath>
#include <memory>
#include <random>

#include "algo/core/math.hpp"
#include "algo/trajectory/bicycle.hpp"
#include "algo/trajectory/optimizer.hpp"
#include "algo/trajectory/roll_out.hpp"
#include "tests/support/driving_scenes.hpp"

namespace s4tp::test {

struct RefinementScene {
  LaneMap map;
  scene::Scene scene;
  Parameters parameters;
  trajectory::ReferenceLine line;
  trajectory::Candidate candidate;
  Trajectory trajectory;
  satp::PredictionSet prediction;
  satp::KinematicSet constant_velocity;
  trajectory::RefinementProblem problem;
  trajectory::Motion start;

  [[nodiscard]] trajectory::Surroundings surroundings() const {
    return {scene, prediction, prediction, constant_velocity};
  }
  void build() {
    trajectory::build_refinement(line, candidate.start_s_m, surroundings(), parameters, trajectory, problem);
    trajectory::reference_motion(problem, start);
  }
};

/// A curved road with up to three steady vehicles beside or ahead, and a feasible candidate on it.
/// \return null when what was drawn is not feasible
inline std::unique_ptr<RefinementScene> random_refinement(unsigned seed) {
  std::mt19937 random(seed);
  const auto draw = [&](float low, float high) {
    return low + (high - low) * static_cast<float>(random() % 10001U) * 1e-4F;
  };
  auto made = std::make_unique<RefinementScene>();
  // Each draw by itself: in what order arguments are made is the compiler's choice.
  const float turn_rad = draw(-1.5F, 1.5F);
  made->map = curved_road(draw(12.0F, 100.0F), turn_rad);
  const scene::LanePath path = path_of(made->map, {0, 1, 2});
  (void)add_ego_path(made->scene, made->map, path);
  const float start_s_m = draw(5.0F, 80.0F);
  const float offset_m = draw(-0.8F, 0.8F);
  TrajectoryPoint start = state_on(made->map, path, start_s_m, draw(0.0F, 14.0F), offset_m);
  if (random() % 5U == 0U) start.speed_mps = 0.0F;
  start.rear_axle.heading_rad = wrap_angle(start.rear_axle.heading_rad + draw(-0.1F, 0.1F));
  start.curvature_1pm = scene::path_point(made->map, path, start_s_m).curvature_1pm + draw(-0.02F, 0.02F);
  start.acceleration_mps2 = start.speed_mps > 0.0F ? draw(-2.0F, 2.0F) : 0.0F;
  put_ego(made->scene, start);

  trajectory::build_reference(made->map, path, start_s_m, start.speed_mps, made->parameters, made->line);
  const trajectory::ReferenceCoordinates where =
      trajectory::locate_on(made->line, position(start.rear_axle), start_s_m);
  trajectory::Candidate& candidate = made->candidate;
  if (random() % 3U == 0U) {
    candidate.intent = trajectory::Intent::kStop;
    candidate.acceleration_mps2 = made->parameters.comfort.acceleration_mps2;
    candidate.target_s_m = start_s_m + 0.3F * start.speed_mps * start.speed_mps + draw(0.5F, 20.0F);
  } else {
    candidate.acceleration_mps2 = draw(-4.0F, 3.0F);
  }
  float length_m = trajectory::lateral_length_m(made->line, start, where, made->parameters);
  for (int i = 0; i < 4; ++i, length_m *= 1.7F) {
    trajectory::shape_lateral(made->line, start, where, length_m, candidate);
    trajectory::roll_out(made->line, candidate, start, Plan{}, 0, made->parameters, made->trajectory);
    if (trajectory::feasible(made->trajectory, made->parameters)) break;
  }
  if (!trajectory::feasible(made->trajectory, made->parameters)) return nullptr;

  const int vehicles = static_cast<int>(random() % 4U);
  for (int i = 0; i < vehicles; ++i) {
    const float ahead_m = draw(-8.0F, 30.0F);
    const float beside_m = draw(2.1F, 4.0F);
    const float left_m = random() % 2U == 0U ? beside_m : -beside_m;
    const bool in_lane = random() % 4U == 0U;
    const scene::Agent& agent = add_vehicle(made->scene, made->map, path, start_s_m + ahead_m,
                                            draw(0.0F, 12.0F), in_lane ? 0.0F : left_m);
    (void)made->constant_velocity.agents.push(steady_future(made->map, agent));
    satp::AgentPrediction predicted;
    predicted.agent = static_cast<std::uint8_t>(i);
    (void)predicted.modes.push(steady_future(made->map, agent));
    (void)made->prediction.agents.push(predicted);
  }
  made->build();
  return made;
}

}  // namespace s4tp::test
