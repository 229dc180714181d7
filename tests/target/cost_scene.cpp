#include "tests/target/cost_scene.hpp"

#include "algo/core/inline.hpp"

namespace s4tp::test {
namespace {

constexpr std::uint32_t kBeginMs = 100'000;

/// Genes in the order in which they are read.
class Genes {
 public:
  explicit Genes(const std::uint8_t* genes) : genes_(genes) {}
  int below(int bound) { return *genes_++ % bound; }
  /// low .. high
  float real(float low, float high) { return lerp(low, high, static_cast<float>(*genes_++) / 255.0F); }

 private:
  const std::uint8_t* genes_;
};

/// Sets points and lengths: an arc from `start`. \return the pose at its end
Pose draw(Lane& lane, Pose start, float length_m, float curvature_1pm, int points) {
  const float step_m = length_m / static_cast<float>(points - 1);
  lane.present = true;
  lane.on_route = true;
  lane.point_count = static_cast<std::uint8_t>(points);
  lane.length_m = length_m;
  lane.points[0] = position(start);
  for (int i = 1; i < points; ++i) {
    start.heading_rad = wrap_angle(start.heading_rad + 0.5F * curvature_1pm * step_m);
    start = shift_ahead(start, step_m);
    start.heading_rad = wrap_angle(start.heading_rad + 0.5F * curvature_1pm * step_m);
    lane.points[i] = position(start);
  }
  return start;
}

void link(LaneMap& map, int from, int to) {
  for (LaneIndex& successor : map.lanes[from].successors) {
    if (successor != kNoLaneIndex) continue;
    successor = static_cast<LaneIndex>(to);
    return;
  }
}

void beside(LaneMap& map, int right, int left) {
  map.lanes[right].left = static_cast<LaneIndex>(left);
  map.lanes[left].right = static_cast<LaneIndex>(right);
}

/// Of two lanes about from their parts `from` to `to`. \param rule  who gives way
void cross(LaneMap& map, int first, int second, float from, float to, int rule) {
  const float first_m = map.lanes[first].length_m;
  const float second_m = map.lanes[second].length_m;
  (void)map.conflicts.push({static_cast<LaneIndex>(first), static_cast<LaneIndex>(second),
                            static_cast<Priority>(rule % 3), from * first_m, to * first_m, from * second_m,
                            to * second_m});
}

void make_road(Genes genes, LaneMap& map) {
  const int ours = 1 + genes.below(5);
  const int opposite = genes.below(4);
  const int segments =
      1 + genes.below(kMaxLanes / (ours + opposite) < 10 ? kMaxLanes / (ours + opposite) : 10);
  const int points = 2 + genes.below(kMaxLanePoints - 1);
  const float length_m = genes.real(20.0F, 300.0F) / static_cast<float>(segments);
  const float width_m = genes.real(2.5F, 4.0F);
  const float limit_mps = genes.real(3.0F, 36.0F);
  const float bend_1pm = genes.real(-0.04F, 0.04F);
  const bool winds = genes.below(2) == 1;
  const int ramps = genes.below(9);
  const int route = genes.below(ours + 1) - 1;  // its lane; -1: any
  const int rules = genes.below(256);
  const float from = genes.real(0.0F, 0.8F);
  const int all = ours + opposite;
  for (int k = 0; k < all; ++k) {
    const float left_m = static_cast<float>(k) * width_m;
    Pose at = {0.0F, left_m, 0.0F};
    for (int j = 0; j < segments; ++j) {
      // Beside the first lane the radius is another one.
      const float turn_1pm = winds && j % 2 == 1 ? -bend_1pm : bend_1pm;
      const float scale = max(1.0F - turn_1pm * left_m, 0.2F);
      Lane& lane = map.lanes[j * all + k];
      at = draw(lane, at, scale * length_m, turn_1pm / scale, points);
      lane.kind = k < ours ? LaneKind::kOurs : LaneKind::kOpposite;
      lane.width_m = width_m;
      lane.speed_limit_mps = limit_mps;
      lane.route_remaining_m = lane.goal_distance_m = static_cast<float>(segments - j) * length_m;
      if (route >= 0 && k < ours) lane.changes_needed = static_cast<std::int8_t>(route - k);
      if (k > 0 && k != ours) beside(map, j * all + k - 1, j * all + k);
      if (k < ours && j > 0) link(map, (j - 1) * all + k, j * all + k);
    }
    if (k < ours) continue;
    for (int j = 0; j < segments; ++j) {  // the other way round
      Lane& lane = map.lanes[j * all + k];
      for (int i = 0; i < points / 2; ++i) {
        const Point last = lane.points[points - 1 - i];
        lane.points[points - 1 - i] = lane.points[i];
        lane.points[i] = last;
      }
      if (j > 0) link(map, j * all + k, (j - 1) * all + k);
    }
  }
  for (int i = 0; i < ramps && segments > 1; ++i) {
    const int slot = all * segments + i;
    const int segment = i % (segments - 1);
    if (slot >= kMaxLanes) break;
    const Lane& right = map.lanes[segment * all];
    const Lane& next = map.lanes[(segment + 1) * all];
    Lane& ramp = map.lanes[slot];
    const Point end = next.points[0];
    const float side = i / (segments - 1) % 2 == 0 ? -0.2F : -0.4F;
    const Point along = end - right.points[0];
    Pose start = {end.x_m, end.y_m, atan2(along.y_m, along.x_m) - side};
    start = shift_ahead(start, -length_m);
    (void)draw(ramp, start, length_m, 0.0F, points);
    ramp.width_m = width_m;
    ramp.speed_limit_mps = limit_mps;
    ramp.route_remaining_m = ramp.goal_distance_m = static_cast<float>(segments - segment) * length_m;
    ramp.in_junction = map.lanes[segment * all].in_junction = true;
    link(map, slot, (segment + 1) * all);
    cross(map, slot, segment * all, from, 1.0F, rules >> (i % 6));
  }
}

void make_star(Genes genes, LaneMap& map) {
  const int arms = 3 + genes.below(3);
  const int lanes = 1 + genes.below(arms == 3 ? 4 : (arms == 4 ? 3 : 2));
  const int points = 2 + genes.below(kMaxLanePoints - 1);
  const float arm_m = genes.real(15.0F, 120.0F);
  const float half_m = genes.real(6.0F, 30.0F);
  const float width_m = genes.real(2.5F, 4.0F);
  const float limit_mps = genes.real(3.0F, 25.0F);
  const float from = genes.real(0.0F, 0.6F);
  const float to = genes.real(0.6F, 1.0F);
  const int rules = genes.below(256);
  const int exits = 1 + genes.below(3);
  const int stop = genes.below(2);
  const auto in = [&](int arm, int k) { return 2 * (arm * lanes + k); };
  const auto out = [&](int arm, int k) { return 2 * (arm * lanes + k) + 1; };
  for (int arm = 0; arm < arms; ++arm) {
    const float heading = wrap_angle(kTwoPi * static_cast<float>(arm) / static_cast<float>(arms));
    for (int k = 0; k < lanes; ++k) {
      const float right_m = (static_cast<float>(lanes - 1 - k) + 0.5F) * width_m;
      const Pose axis = {0.0F, 0.0F, heading};
      const Point entry = offset_point(axis, -half_m - arm_m, -right_m);
      const Point leave = offset_point(axis, -half_m, right_m);
      Lane& inward = map.lanes[in(arm, k)];
      (void)draw(inward, {entry.x_m, entry.y_m, heading}, arm_m, 0.0F, points);
      if (stop == 1) inward.stop_line_m = arm_m - 0.5F;
      Lane& outward = map.lanes[out(arm, k)];
      (void)draw(outward, {leave.x_m, leave.y_m, wrap_angle(heading + kPi)}, arm_m, 0.0F, points);
      inward.width_m = outward.width_m = width_m;
      inward.speed_limit_mps = outward.speed_limit_mps = limit_mps;
      inward.route_remaining_m = inward.goal_distance_m = 2.0F * (arm_m + half_m);
      outward.route_remaining_m = outward.goal_distance_m = arm_m;
      if (k > 0) {
        beside(map, in(arm, k - 1), in(arm, k));
        beside(map, out(arm, k - 1), out(arm, k));
      }
    }
  }
  int slot = 2 * arms * lanes;
  const int first = slot;
  for (int arm = 0; arm < arms; ++arm) {
    for (int k = 0; k < lanes; ++k) {
      for (int turn = 0; turn < exits && turn + 1 < arms && slot < kMaxLanes; ++turn, ++slot) {
        const Lane& inward = map.lanes[in(arm, k)];
        const int target = out((arm + 1 + turn) % arms, k);
        const Point a = inward.points[points - 1];
        const Point b = map.lanes[target].points[0];
        const Point chord = b - a;
        const Point in_ahead = inward.points[1] - inward.points[0];
        // An arc whose chord is turned by half of what it turns.
        const float half_turn = atan2(s4tp::cross(in_ahead, chord), dot(in_ahead, chord));
        const float chord_m = max(norm(chord), 1.0F);
        const float curvature_1pm = 2.0F * sin(half_turn) / chord_m;
        const float length_m = abs(half_turn) < 0.01F ? chord_m : abs(2.0F * half_turn / curvature_1pm);
        Lane& lane = map.lanes[slot];
        (void)draw(lane, {a.x_m, a.y_m, atan2(in_ahead.y_m, in_ahead.x_m)}, length_m, curvature_1pm, points);
        lane.in_junction = true;
        lane.width_m = width_m;
        lane.speed_limit_mps = limit_mps;
        lane.route_remaining_m = lane.goal_distance_m = arm_m + length_m;
        link(map, in(arm, k), slot);
        link(map, slot, target);
      }
    }
  }
  for (int a = first; a < slot; ++a) {
    for (int b = a + 1; b < slot; ++b) {
      const bool same_entry = (a - first) / exits == (b - first) / exits;
      if (!same_entry) cross(map, a, b, from, to, (rules >> (a % 5)) + b);
    }
  }
}

/// A place on a lane.
Pose on_lane(const LaneMap& map, int index, float share) {
  int lanes = 0;
  for (const Lane& lane : map.lanes) lanes += lane.present ? 1 : 0;
  const Lane& lane = map.lanes[index % lanes];
  const float at = share * static_cast<float>(lane.point_count - 1);
  const int from = to_int(at - 0.5F, 0, lane.point_count - 2);
  const Point a = lane.points[from];
  const Point along = lane.points[from + 1] - a;
  const Point place = a + (at - static_cast<float>(from)) * along;
  return {place.x_m, place.y_m, atan2(along.y_m, along.x_m)};
}

Pose moved(const Pose& pose, float ahead_m, float left_m, float turned_rad) {
  const Point place = offset_point(pose, ahead_m, left_m);
  return {place.x_m, place.y_m, wrap_angle(pose.heading_rad + turned_rad)};
}

void make_ego(Genes& genes, const LaneMap& map, EgoState& ego) {
  const int lane = genes.below(256);
  const float share = genes.real(0.0F, 1.0F);
  const float left_m = genes.real(-2.0F, 2.0F);
  const float turned_rad = genes.real(-0.4F, 0.4F);
  ego.rear_axle = moved(on_lane(map, lane, share), 0.0F, left_m, turned_rad);
  ego.speed_mps = genes.real(0.0F, 30.0F);
  ego.acceleration_mps2 = genes.real(-6.0F, 3.0F);
  ego.steering_rad = genes.real(-0.3F, 0.3F);
}

/// Somewhere on a lane, anywhere around us, or on the way to one place ahead of us.
void make_track(Genes genes, const LaneMap& map, const Pose& ego, const Pose& focus, Track& track) {
  const int kind = genes.below(4);
  const int lane = genes.below(256);
  const float a = genes.real(-1.0F, 1.0F);
  const float b = genes.real(-1.0F, 1.0F);
  const float turned = genes.real(-1.0F, 1.0F);
  track.speed_mps = max(genes.real(-4.0F, 30.0F), 0.0F);
  track.acceleration_mps2 = genes.real(-6.0F, 4.0F);
  track.yaw_rate_radps = genes.real(-0.8F, 0.8F);
  track.length_m = genes.real(0.6F, 25.0F);
  track.width_m = genes.real(0.4F, 3.0F);
  if (kind == 0) {
    track.centre = moved(on_lane(map, lane, 0.5F + 0.5F * a), 0.0F, 2.0F * b, 0.3F * turned);
  } else if (kind == 1) {
    track.centre = moved(ego, 60.0F * a, 15.0F * b, kPi * turned);
  } else if (kind == 2) {
    const Pose away = {focus.x_m, focus.y_m, wrap_angle(kPi * a)};
    track.centre = moved(away, 12.5F * (1.0F + b), 0.0F, -kPi);
    track.centre.heading_rad = wrap_angle(track.centre.heading_rad + 0.5F * turned);
  } else {  // the same, of usual size
    const Pose away = {focus.x_m, focus.y_m, wrap_angle(kTwoPi * static_cast<float>(lane % 16) / 16.0F)};
    track.centre = moved(away, 12.0F + 2.0F * b, 0.0F, -kPi);
    track.speed_mps = 8.0F + 3.0F * turned;
    track.acceleration_mps2 = track.yaw_rate_radps = 0.0F;
    track.length_m = 4.6F;
    track.width_m = 1.8F;
  }
}

}  // namespace

void CostScene::make(const Genome& genome) {
  for (Lane& lane : map_.lanes) lane = Lane{};
  map_.conflicts.clear();
  input_ = planner::PlannerInput{};
  Genes map_genes(genome.genes);
  const int family = map_genes.below(2);
  family == 0 ? make_road(map_genes, map_) : make_star(map_genes, map_);
  Genes ego_genes(genome.genes + kMapGenes);
  make_ego(ego_genes, map_, input_.ego);
  const Pose focus = moved(input_.ego.rear_axle, ego_genes.real(0.0F, 60.0F), 0.0F, 0.0F);
  const int tracks = ego_genes.below(kMaxTracks + 1);
  input_.degraded = ego_genes.below(8) == 7 ? 1 : 0;
  for (int i = 0; i < tracks; ++i) {
    Track track;
    track.id = static_cast<std::uint8_t>(i);
    make_track(Genes(genome.genes + kMapGenes + kEgoGenes + i * kTrackGenes), map_, input_.ego.rear_axle,
               focus, track);
    (void)input_.tracks.push(track);
  }
  Genes missing_genes(genome.genes + kMapGenes + kEgoGenes + kMaxTracks * kTrackGenes);
  input_.tracks.left_out = missing_genes.below(4) == 3 ? 1 : 0;
  map_.lanes_left_out = missing_genes.below(4) == 3 ? 1 : 0;
  input_.now_ms = input_.tracks_ms = kBeginMs;
  input_.start_ms = kBeginMs + kStepMs;
  input_.map = &map_;
}

void CostScene::advance(const Plan& plan) {
  running_ = plan;
  input_.running = &running_;
  input_.now_ms = input_.tracks_ms = input_.start_ms;
  input_.start_ms = input_.now_ms + kStepMs;
  const TrajectoryPoint at = sample(plan, input_.now_ms);
  input_.ego.rear_axle = at.rear_axle;
  input_.ego.speed_mps = at.speed_mps;
  input_.ego.acceleration_mps2 = clamp(at.acceleration_mps2, -12.0F, 12.0F);
  for (Track& track : input_.tracks) {
    track.centre = shift_ahead(track.centre, kStepS * track.speed_mps);
    track.centre.heading_rad = wrap_angle(track.centre.heading_rad + kStepS * track.yaw_rate_radps);
  }
}

}  // namespace s4tp::test
