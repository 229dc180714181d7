#include "algo/behavior/lane_change.hpp"

#include "algo/core/inline.hpp"
#include "algo/occupancy/pace.hpp"
#include "algo/scene/lane_path.hpp"

namespace s4tp::behavior {
namespace {

using Situation = LaneChangeSituation;

bool begins(const Situation& s) {
  return s.leads_over;
}
bool begins_over_line(const Situation& s) {
  return s.leads_over && s.over_line;
}
bool over_half(const Situation& s) {
  return s.over_half;
}
bool turns(const Situation& s) {
  return s.leads_over && !s.goes_on;
}
bool dropped(const Situation& s) {
  return !s.goes_on;
}
bool over_line(const Situation& s) {
  return s.over_line;
}
bool inside(const Situation& s) {
  return s.inside;
}
bool settled(const Situation& s) {
  return s.inside && s.settled;
}

/// In the lane a change leads to we are short of its centre, in the one it leaves beyond.
bool is_over_half(const ManoeuvreState& state, const scene::Scene& scene) {
  const scene::EgoPath& own = scene.ego_paths[0];
  const float width_m = scene::path_point(*scene.map, own.path, own.frenet.s_m).width_m;
  return static_cast<float>(state.side) * own.frenet.d_m < -scene::kBesideShare * width_m;
}

bool under_way(const ManoeuvreState& state) {
  return state.lane_change == LaneChange::kPrepare || state.lane_change == LaneChange::kCrossing;
}

}  // namespace

const Transition<LaneChange, Situation> kLaneChangeTable[kLaneChangeRows] = {
    {LaneChange::kKeep, begins_over_line, LaneChange::kCrossing},
    {LaneChange::kKeep, begins, LaneChange::kPrepare},
    {LaneChange::kPrepare, over_half, LaneChange::kFinish},
    {LaneChange::kPrepare, turns, LaneChange::kPrepare},
    {LaneChange::kPrepare, dropped, LaneChange::kKeep},
    {LaneChange::kPrepare, over_line, LaneChange::kCrossing},
    {LaneChange::kCrossing, over_half, LaneChange::kFinish},
    {LaneChange::kCrossing, dropped, LaneChange::kSettle},
    {LaneChange::kFinish, begins_over_line, LaneChange::kCrossing},
    {LaneChange::kFinish, begins, LaneChange::kPrepare},
    {LaneChange::kFinish, inside, LaneChange::kSettle},
    {LaneChange::kSettle, begins_over_line, LaneChange::kCrossing},
    {LaneChange::kSettle, begins, LaneChange::kPrepare},
    {LaneChange::kSettle, settled, LaneChange::kKeep},
};

LaneChangeSituation lane_change_situation(const ManoeuvreState& state, int side, const scene::Scene& scene,
                                          const Parameters& parameters) {
  const scene::EgoPath& own = scene.ego_paths[0];
  const auto& vehicle = parameters.vehicle;
  // Our box across the lane under us.
  const float sine = sin(wrap_angle(scene.ego.rear_axle.heading_rad - own.frenet.heading_rad));
  const float centre_m = 0.5F * vehicle.length_m - vehicle.rear_overhang_m;
  const float centre_d_m = own.frenet.d_m + centre_m * sine;
  const float half_m = 0.5F * (vehicle.width_m + abs(sine) * vehicle.length_m);
  const float edge_m = 0.5F * scene::path_point(*scene.map, own.path, own.frenet.s_m).width_m;
  LaneChangeSituation situation;
  situation.over_half = under_way(state) && is_over_half(state, scene);
  situation.leads_over = side != 0;
  situation.goes_on = side != 0 && side == state.side;
  situation.over_line = static_cast<float>(side) * centre_d_m + half_m > edge_m;
  situation.inside = abs(centre_d_m) + half_m <= edge_m;
  situation.settled = 1e-3F * static_cast<float>(state.lane_change_ms) > occupancy::kSettleS;
  return situation;
}

int leads_to(const ManoeuvreState& state, const scene::Scene& scene) {
  if (!under_way(state) || scene.ego_paths.empty() || is_over_half(state, scene)) return 0;
  const scene::Manoeuvre manoeuvre = state.side > 0 ? scene::Manoeuvre::kLeft : scene::Manoeuvre::kRight;
  for (int i = 1; i < scene.ego_paths.size(); ++i) {
    if (scene.ego_paths[i].manoeuvre == manoeuvre) return i;
  }
  return 0;
}

}  // namespace s4tp::behavior
