#include "algo/scene/ego_paths.hpp"

#include "algo/core/inline.hpp"
#include "algo/core/sort.hpp"
#include "algo/scene/conflict_view.hpp"

namespace s4tp::scene {
namespace {

constexpr float kAheadM = 150.0F;        // the map's own horizon
constexpr float kBehindStartM = 10.0F;   // a neighbour lane may begin this far ahead of us
constexpr float kShortOfLineM = 0.5F;    // a little too far, and others see us in the junction
constexpr float kPassedLineM = 0.5F;     // a stop line this far behind our front no longer binds
constexpr float kJunctionReachM = 8.0F;  // zones this close behind a junction still belong to it
constexpr float kHalfMadeS = 1.0F;       // a lane change is half made so long after it has begun
constexpr float kBegunM = 0.5F;          // ... when we are so far off our lane's centre
constexpr float kNowhereM = 1e6F;        // where there is no stop line
constexpr float kStraightRad = 0.05F;    // turns that differ by less are equally straight

// Work (WorkMeter's units).
constexpr int kPathWork = 110;
constexpr int kZoneWork = 4;

// Whether the route asks for `a` rather than `b`.
bool better_successor(const LaneTable& table, LaneIndex a, LaneIndex b) {
  const Lane& lane_a = table.lane(a);
  const Lane& lane_b = table.lane(b);
  if (lane_a.on_route != lane_b.on_route) return lane_a.on_route;
  if (lane_a.on_route) {
    const int changes_a = lane_a.changes_needed < 0 ? -lane_a.changes_needed : lane_a.changes_needed;
    const int changes_b = lane_b.changes_needed < 0 ? -lane_b.changes_needed : lane_b.changes_needed;
    if (changes_a != changes_b) return changes_a < changes_b;
    if (lane_a.route_remaining_m != lane_b.route_remaining_m) {
      return lane_a.route_remaining_m > lane_b.route_remaining_m;
    }
  }
  return abs(table.bend(a).turn_rad) + kStraightRad < abs(table.bend(b).turn_rad);
}

LanePath path_from(const LaneTable& table, LaneIndex first, float until_s_m) {
  LanePath path;
  LaneIndex next = first;
  while (next != kNoLaneIndex && table.append(path, next) && path.length_m < until_s_m) {
    const Lane& lane = table.lane(next);
    next = kNoLaneIndex;
    for (LaneIndex successor : lane.successors) {
      if (!table.valid(successor)) continue;
      if (next == kNoLaneIndex || better_successor(table, successor, next)) next = successor;
    }
  }
  return path;
}

// The stop line that guards path position `entry_s_m` on path lane `index`: of the lane before the junction.
float stop_line(const LaneTable& table, const LanePath& path, int index, float entry_s_m) {
  const bool inside = table.lane(path.lanes[index].lane).in_junction ||
                      entry_s_m - path.lanes[index].start_s_m < kJunctionReachM;
  for (int i = index; i >= 0; --i) {
    const Lane& lane = table.lane(path.lanes[i].lane);
    const float line_s_m = path.lanes[i].start_s_m + lane.stop_line_m;
    if (lane.stop_line_m >= 0.0F && line_s_m <= entry_s_m + kUsualHalfLengthM) return line_s_m;
    if (!inside || (i < index && !lane.in_junction)) break;
  }
  return kNowhereM;
}

// Which zone to keep when there is no room for all: where we must give way, then the nearer one.
bool matters_more(const ConflictZone& a, const ConflictZone& b) {
  const bool yields_a = a.priority != Priority::kFirstHasPriority;
  const bool yields_b = b.priority != Priority::kFirstHasPriority;
  if (yields_a != yields_b) return yields_a;
  return a.entry_s_m < b.entry_s_m;
}

}  // namespace

void add_zone(const ConflictZone& zone, EgoPath& ego_path) {
  // The end of a lane and the lane after it meet the same other lane in one stretch: one zone.
  for (ConflictZone& known : ego_path.zones) {
    if (known.other_lane != zone.other_lane || known.priority != zone.priority) continue;
    if (known.beside != zone.beside) continue;
    if (zone.entry_s_m > known.exit_s_m + 1.0F || known.entry_s_m > zone.exit_s_m + 1.0F) continue;
    known.entry_s_m = min(known.entry_s_m, zone.entry_s_m);
    known.exit_s_m = max(known.exit_s_m, zone.exit_s_m);
    known.stop_s_m = min(known.stop_s_m, zone.stop_s_m);
    known.other_entry_m = min(known.other_entry_m, zone.other_entry_m);
    known.other_exit_m = max(known.other_exit_m, zone.other_exit_m);
    return;
  }
  if (ego_path.zones.push(zone)) return;
  int least = 0;
  for (int i = 1; i < ego_path.zones.size(); ++i) {
    if (matters_more(ego_path.zones[least], ego_path.zones[i])) least = i;
  }
  if (matters_more(zone, ego_path.zones[least])) ego_path.zones[least] = zone;
}

void sort_zones(EgoPath& ego_path) {
  sort(ego_path.zones,
       [](const ConflictZone& a, const ConflictZone& b) { return a.entry_s_m < b.entry_s_m; });
}

namespace {

void find_zones(const LaneTable& table, const Parameters& parameters, EgoPath& ego_path) {
  std::int8_t place[kMaxLanes];  // of each lane along the path, or -1
  for (std::int8_t& index : place) index = -1;
  const LanePath& path = ego_path.path;
  for (int i = 0; i < path.lanes.size(); ++i) place[path.lanes[i].lane] = static_cast<std::int8_t>(i);

  const float half_length_m = 0.5F * parameters.vehicle.length_m;
  const float centre_s_m = ego_path.frenet.s_m + half_length_m - parameters.vehicle.rear_overhang_m;
  for (const Conflict& conflict : table.map().conflicts) {
    if (!sound(conflict) || !table.valid(conflict.first) || !table.valid(conflict.second)) continue;
    const bool second_ours = place[conflict.second] >= 0;
    if ((place[conflict.first] >= 0) == second_ours) continue;  // none of our business, or our own way
    table.spend(kZoneWork);
    const ConflictView view = view_from(conflict, second_ours);
    const int index = place[view.own];
    const float start_s_m = path.lanes[index].start_s_m;
    // The map's zones are for a usual box; ours may be longer or shorter.
    const float longer_m = half_length_m - kUsualHalfLengthM;
    ConflictZone zone;
    zone.entry_s_m = start_s_m + view.own_entry_m - longer_m;
    zone.exit_s_m = start_s_m + view.own_exit_m + longer_m;
    if (zone.exit_s_m < centre_s_m) continue;
    zone.other_lane = view.other;
    zone.other_entry_m = view.other_entry_m;
    zone.other_exit_m = view.other_exit_m;
    zone.priority = view.priority;
    for (const LaneIndex successor : table.map().lanes[view.other].successors) {
      if (table.valid(successor) && place[successor] >= 0) zone.merging = true;
    }
    const float edge_s_m = zone.entry_s_m + half_length_m - kStopMarginM;
    const float line_s_m = stop_line(table, path, index, zone.entry_s_m);
    const bool passed = centre_s_m + half_length_m > line_s_m + kPassedLineM;
    zone.stop_s_m = passed ? edge_s_m : min(edge_s_m, line_s_m - kShortOfLineM);
    add_zone(zone, ego_path);
  }
  sort_zones(ego_path);
}

LaneIndex lane_beside(const LaneTable& table, LaneIndex index, bool left) {
  const Lane& lane = table.lane(index);
  const LaneIndex beside = left ? lane.left : lane.right;
  return !lane.in_junction && table.valid(beside) ? beside : kNoLaneIndex;
}

// Between which places the changes that part `last` of the path asks for can be made: from the first lane on that asks for
// some of them and has one beside. What lies between, as the seams of junctions, is passed as it is.
void find_change_places(const LaneTable& table, int last, EgoPath& ego_path) {
  const bool left = ego_path.changes_needed > 0;
  const int changes = left ? ego_path.changes_needed : -ego_path.changes_needed;
  const PathLane& part = ego_path.path.lanes[last];
  const auto can_change = [&](const PathLane& there) {
    const Lane& lane = table.lane(there.lane);
    return (left ? lane.changes_needed > 0 : lane.changes_needed < 0) &&
           lane_beside(table, there.lane, left) != kNoLaneIndex;
  };
  int first = 0;
  while (first < last && !can_change(ego_path.path.lanes[first])) ++first;
  ego_path.change_from_s_m = ego_path.path.lanes[first].start_s_m;
  LaneIndex index = part.lane;
  float by_s_m = ego_path.route_end_s_m;
  for (int i = 0; i < changes && ego_path.change_by_s_m.push(by_s_m); ++i) {
    const LaneIndex beside = lane_beside(table, index, left);
    if (beside == kNoLaneIndex) continue;
    index = beside;
    by_s_m = max(by_s_m, part.start_s_m + table.lane(index).route_remaining_m);
  }
}

// What is to be changed on the last lane that leads on says the lane itself: on a ramp there is none beside before.
void follow_route(const LaneTable& table, EgoPath& ego_path) {
  const LanePath& path = ego_path.path;
  int last = -1;
  ego_path.route_end_s_m = path.length_m;
  ego_path.goal_s_m = path.length_m;
  for (int i = 0; i < path.lanes.size(); ++i) {
    const PathLane& part = path.lanes[i];
    const Lane& lane = table.lane(part.lane);
    if (!lane.on_route || part.start_s_m >= ego_path.route_end_s_m) {
      if (last >= 0) break;
      continue;
    }
    last = i;
    ego_path.changes_needed = lane.changes_needed;
    // Where the path ends because we look no further, the route does not: a change that is due beyond has its room there.
    ego_path.route_end_s_m = part.start_s_m + max(lane.route_remaining_m, 0.0F);
    ego_path.goal_s_m = part.start_s_m + lane.goal_distance_m;
  }
  if (last >= 0) find_change_places(table, last, ego_path);
}

// Whether a change to the path, from the lane beside, is half made before a junction begins: what is beside us then leads
// elsewhere.
bool is_made_in_time(const LaneTable& table, const EgoPath& ego_path, float speed_mps) {
  const Lane& first = table.lane(ego_path.path.lanes[0].lane);
  if (abs(ego_path.frenet.d_m) < first.width_m - kBegunM) return true;
  for (const PathLane& part : ego_path.path.lanes) {
    if (table.lane(part.lane).in_junction)
      return ego_path.frenet.s_m + kHalfMadeS * speed_mps < part.start_s_m;
  }
  return true;
}

void add_path(const LaneTable& table, Manoeuvre manoeuvre, LaneIndex lane, const Parameters& parameters,
              Scene& scene) {
  const Point rear_axle = position(scene.ego.rear_axle);
  const float here_s_m = nearest_on_lane(table.lane(lane), rear_axle).s_m;
  EgoPath ego_path;
  ego_path.manoeuvre = manoeuvre;
  ego_path.path = path_from(table, lane, here_s_m + kAheadM);
  constexpr float kReachM = 30.0F;  // beyond the ends of the lane
  int work = kPathWork;
  ego_path.frenet = project(table.map(), ego_path.path, rear_axle, here_s_m, kReachM, work);
  table.spend(work);
  const bool beside = ego_path.frenet.s_m > -kBehindStartM && ego_path.frenet.s_m < ego_path.path.length_m;
  if (manoeuvre != Manoeuvre::kKeep && !(beside && is_made_in_time(table, ego_path, scene.ego.speed_mps)))
    return;
  follow_route(table, ego_path);
  find_zones(table, parameters, ego_path);
  (void)scene.ego_paths.push(ego_path);
}

}  // namespace

void build_ego_paths(const LaneTable& table, LaneIndex lane, const Parameters& parameters, Scene& scene) {
  scene.ego_paths.clear();
  add_path(table, Manoeuvre::kKeep, lane, parameters, scene);
  const LaneIndex left = table.lane(lane).left;
  const LaneIndex right = table.lane(lane).right;
  const auto usable_neighbour = [&](LaneIndex beside) {
    return table.valid(beside) && beside != lane && table.lane(beside).kind == LaneKind::kOurs;
  };
  if (usable_neighbour(left)) add_path(table, Manoeuvre::kLeft, left, parameters, scene);
  if (usable_neighbour(right) && right != left) {
    add_path(table, Manoeuvre::kRight, right, parameters, scene);
  }
}

}  // namespace s4tp::scene
