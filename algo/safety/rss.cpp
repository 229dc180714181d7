#include "algo/safety/rss.hpp"

#include "algo/core/inline.hpp"
#include "algo/trajectory/along_path.hpp"
#include "algo/trajectory/bicycle.hpp"
#include "algo/trajectory/path_walk.hpp"

namespace s4tp {
namespace {

constexpr float kUnrestrictedMps = 10.0F;
constexpr float kResponseHoldS = 1.0F;  // a plan is clipped this far; the next cycle knows more
constexpr float kDelayS = 0.1F;
constexpr float kTouchM = 0.1F;
constexpr float kTinyM = 1e-3F;
constexpr float kEndReachM = 15.0F;  // a plan's end is this near to where its length leads along the path

/// Response that keeps the follower out of reach of a leader braking at b_max.
///
/// Of the safe distance d, the part d_0 = v_r^2 / 2 b_min - v_f^2 / 2 b_max is needed even by a follower that
/// brakes at once; the rest is the reserve for its response time. With a share u of the reserve used, braking
/// at u b_min uses it up ever more slowly (d reserve / dt = -v_r (1 - u)): it lasts for ever, and the
/// response is as soft as the situation allows.
float longitudinal_response_mps2(float gap_m, float rear_mps, float front_mps, const Parameters& parameters) {
  const auto& rss = parameters.rss;
  const float safe_m = safe_distance_m(rear_mps, front_mps, parameters);
  const float at_once_m =
      square(rear_mps) / (2.0F * rss.braking_min_mps2) - square(front_mps) / (2.0F * rss.braking_max_mps2);
  const float held_back_m = kDelayS * rear_mps + kTouchM;
  const float reserve_m = max(safe_m - max(at_once_m, 0.0F) - held_back_m, kTinyM);
  const float used = (safe_m - gap_m) / reserve_m;
  if (used <= 1.0F) return -used * rss.braking_min_mps2;
  // Less than b_min needs: as hard as it takes to stop behind a leader that brakes at b_max.
  const float room_m = max(gap_m - held_back_m + square(front_mps) / (2.0F * rss.braking_max_mps2), kTinyM);
  const float needed_mps2 = square(rear_mps) / (2.0F * room_m);
  return -clamp(needed_mps2, rss.braking_min_mps2,
                max(rss.braking_min_mps2, parameters.vehicle.braking_max_mps2));
}

/// Way covered towards somebody by one who moves at `speed_mps`, answers after rho and then brakes sideways.
float lateral_way_m(float speed_mps, const Parameters& parameters) {
  const auto& rss = parameters.rss;
  const float later_mps = speed_mps + rss.response_s * rss.lateral_acceleration_mps2;
  const float braking_m = later_mps > 0.0F ? square(later_mps) / (2.0F * rss.lateral_braking_mps2) : 0.0F;
  return 0.5F * (speed_mps + later_mps) * rss.response_s + braking_m;
}

/// Whether the plan leaves a leader's strip for good, and before it could reach him.
bool steers_clear(const Scene& scene, const EgoPath& path, const OnPath& seen, const Trajectory& plan,
                  const Parameters& parameters) {
  const auto& rss = parameters.rss;
  const TrajectoryPoint& end = plan.points[kHorizonSteps];
  const float way_m = distance(position(end.rear_axle), position(plan.points[0].rear_axle));
  const Frenet there =
      project(*scene.map, path.path, position(end.rear_axle), path.frenet.s_m + way_m, kEndReachM);
  const bool we_left = there.d_m > seen.centre_d_m;
  const float drift_m = max(0.0F, lateral_way_m(we_left ? seen.left_mps : -seen.left_mps, parameters));
  const float clear_m =
      0.5F * parameters.vehicle.width_m + seen.half_width_m + drift_m + rss.lateral_margin_m;
  if (abs(there.d_m - seen.centre_d_m) < clear_m) return false;

  const float its_d_m = seen.centre_d_m + (we_left ? drift_m : -drift_m);
  PathCursor cursor(*scene.map, path.path);
  float its_s_m = seen.centre_s_m;
  float its_mps = seen.along_mps;
  for (int i = 1; i < kTrajectoryPoints; ++i) {
    const float later_mps = max(0.0F, its_mps - rss.braking_max_mps2 * kStepS);
    its_s_m = its_s_m + 0.5F * (its_mps + later_mps) * kStepS;
    its_mps = later_mps;
    const Pose line = cursor.at(its_s_m).pose;
    const Point centre = offset_point(line, 0.0F, its_d_m);
    const Box its{
        {centre.x_m, centre.y_m, line.heading_rad}, 2.0F * seen.half_length_m, 2.0F * seen.half_width_m};
    if (separation(ego_box(plan.points[i].rear_axle, parameters), its) < rss.lateral_margin_m) return false;
  }
  return true;
}

}  // namespace

float safe_distance_m(float rear_speed_mps, float front_speed_mps, const Parameters& parameters) {
  const auto& rss = parameters.rss;
  const float later_mps = rear_speed_mps + rss.response_s * rss.acceleration_mps2;
  const float response_m =
      rear_speed_mps * rss.response_s + 0.5F * rss.acceleration_mps2 * square(rss.response_s);
  const float rear_m = response_m + square(later_mps) / (2.0F * rss.braking_min_mps2);
  return max(0.0F, rear_m - square(front_speed_mps) / (2.0F * rss.braking_max_mps2));
}

float safe_lateral_m(float speed_a_mps, float speed_b_mps, const Parameters& parameters) {
  const float way_m = lateral_way_m(speed_a_mps, parameters) + lateral_way_m(speed_b_mps, parameters);
  return parameters.rss.lateral_margin_m + max(0.0F, way_m);
}

RssEnvelope rss_envelope(const Scene& scene, const Trajectory& plan, const Parameters& parameters) {
  RssEnvelope envelope;
  envelope.acceleration_max_mps2 = parameters.vehicle.acceleration_max_mps2;
  envelope.lateral_left_max_mps = kUnrestrictedMps;
  envelope.lateral_right_max_mps = kUnrestrictedMps;
  if (scene.ego_paths.empty() || scene.map == nullptr) return envelope;

  const EgoPath& path = scene.ego_paths[0];
  const float speed_mps = scene.ego.speed_mps;
  const float centre_s_m = path.frenet.s_m + rear_axle_to_centre_m(parameters);
  const float half_length_m = 0.5F * parameters.vehicle.length_m;
  const float error_rad = wrap_angle(scene.ego.rear_axle.heading_rad - path.frenet.heading_rad);
  const float own_left_mps = speed_mps * sin(error_rad);

  for (int i = 0; i < scene.agents.size(); ++i) {
    const Agent& agent = scene.agents[i];
    bool known = true;
    const OnPath seen = see_on_path(scene, path, agent, parameters, /*whole_road=*/true, known);
    // Crossing and oncoming traffic is a matter of right of way: the guard answers for it.
    if (!known || seen.crossing || seen.along_mps < 0.0F) continue;

    const float centre_ahead_m = seen.centre_s_m - centre_s_m;
    const float gap_m = abs(centre_ahead_m) - half_length_m - seen.half_length_m;
    const float offset_m = seen.centre_d_m - path.frenet.d_m;
    const float side_gap_m = abs(offset_m) - 0.5F * parameters.vehicle.width_m - seen.half_width_m;
    const bool ahead = centre_ahead_m > 0.0F;
    const float safe_m = ahead ? safe_distance_m(speed_mps, seen.along_mps, parameters)
                               : safe_distance_m(seen.along_mps, speed_mps, parameters);
    if (gap_m >= safe_m) continue;

    if (side_gap_m <= 0.0F) {
      if (!ahead) continue;  // who comes from behind is obliged, not we
      const float response = longitudinal_response_mps2(gap_m, speed_mps, seen.along_mps, parameters);
      if (response >= envelope.acceleration_max_mps2) continue;
      if (steers_clear(scene, path, seen, plan, parameters)) continue;
      envelope.acceleration_max_mps2 = response;
      envelope.agent = static_cast<std::uint8_t>(i);
      envelope.active = true;
      continue;
    }
    const bool on_left = offset_m > 0.0F;
    const float towards_mps = on_left ? own_left_mps : -own_left_mps;
    const float its_left_mps = seen.left_mps;
    const float its_towards_mps = on_left ? -its_left_mps : its_left_mps;
    if (side_gap_m >= safe_lateral_m(towards_mps, its_towards_mps, parameters)) continue;
    (on_left ? envelope.lateral_left_max_mps : envelope.lateral_right_max_mps) = 0.0F;
    if (envelope.agent == RssEnvelope{}.agent) envelope.agent = static_cast<std::uint8_t>(i);
    envelope.active = true;
  }
  return envelope;
}

bool clip_to_envelope(const RssEnvelope& envelope, const Parameters& parameters, Trajectory& trajectory) {
  if (!envelope.active) return false;
  const int held = to_int(kResponseHoldS / kStepS, 1, kHorizonSteps);
  const float most_mps2 = max(envelope.acceleration_max_mps2, -parameters.vehicle.braking_max_mps2);
  bool changed = false;
  for (int i = 1; i <= held; ++i) changed = changed || trajectory.points[i].acceleration_mps2 > most_mps2;
  if (!changed) return false;

  const Trajectory old = trajectory;
  PathWalk walk(old);
  float way_m = 0.0F;
  float speed_mps = old.points[0].speed_mps;
  for (int i = 1; i < kTrajectoryPoints; ++i) {
    const float asked = (old.points[i].speed_mps - old.points[i - 1].speed_mps) / kStepS;
    const float allowed = i <= held ? most_mps2 : max(most_mps2, 0.0F);
    const float now_mps = max(0.0F, speed_mps + min(asked, allowed) * kStepS);
    const float step_m = 0.5F * (speed_mps + now_mps) * kStepS;
    TrajectoryPoint& point = trajectory.points[i];
    point = trajectory.points[i - 1];
    if (step_m > 0.0F) {
      way_m = way_m + step_m;
      walk.place(way_m, point);
    }
    point.acceleration_mps2 = now_mps > 0.0F ? (now_mps - speed_mps) / kStepS : 0.0F;
    point.speed_mps = now_mps;
    speed_mps = now_mps;
  }
  return true;
}

}  // namespace s4tp
