// Whoever may be beyond the known ground, as the guard sees it before it judges plans.
#include "algo/core/inline.hpp"
#include "algo/safety/guard.hpp"
#include "algo/trajectory/along_path.hpp"

namespace s4tp::safety {
namespace {

using occupancy::kNeverS;
using occupancy::kNoWayM;
using occupancy::LaneReach;

constexpr float kLengthM = 2.0F * scene::kUsualHalfLengthM;  // of whom we expect

// Work (WorkMeter's units).
constexpr int kMostWork = 10'000;  // beyond, somebody is expected everywhere
constexpr int kEdgesWork = 8;      // of a lane, ...
constexpr int kChordWork = 2;      // ... of each of its chords, and ...
constexpr int kTwoAheadWork = 1;   // ... of two chords along our path
constexpr int kLedIntoWork = 290;
constexpr int kExpectWork = 30;
constexpr int kZoneWork = 8;
constexpr int kHeldWork = 1;  // of each vehicle, where somebody may come

bool is_known(const scene::KnownGround& known, Point place) {
  return distance(place, known.centre) < known.radius_m;
}

/// Where a line cuts the known ground's edge [m from `from`]; in > out: it does not.
struct Cut {
  float in_m = 1.0F;
  float out_m = 0.0F;
};
Cut cut(const scene::KnownGround& known, Point from, Point to) {
  const float length_m = distance(from, to);
  if (!(length_m > 0.0F)) return {};
  const Point along = (1.0F / length_m) * (to - from);
  const Point offset = from - known.centre;
  const float middle_m = -dot(offset, along);
  const float half_square = square(known.radius_m) - square(cross(along, offset));
  if (!(half_square > 0.0F)) return {};
  const float half_m = sqrt(half_square);
  return {middle_m - half_m, middle_m + half_m};
}

}  // namespace

void Guard::look_beyond(const LaneReach (&reach)[kMaxTracks]) {
  const scene::KnownGround& known = scene_->known;
  const LaneMap& map = *scene_->map;
  for (int path = 0; path < scene_->ego_paths.size(); ++path)
    expect_ahead(scene_->ego_paths[path], contexts_[path]);
  if (!(known.radius_m > 0.0F)) return expect_everywhere();
  const int most = work_ + kMostWork;
  for (LaneIndex index = 0; index < kMaxLanes; ++index) {
    const Lane& lane = map.lanes[index];
    if (!scene::usable(lane)) continue;
    if (work_ > most) return expect_everywhere();
    work_ += kEdgesWork + kChordWork * (lane.point_count - 1);
    float start_m = 0.0F;
    for (int i = 1; i < lane.point_count; ++i) {
      const Point from = lane.points[i - 1];
      const Point to = lane.points[i];
      const float length_m = distance(from, to);
      const Cut edge = cut(known, from, to);
      // Where it ends known, whatever rounding says, it has come in.
      const bool comes_in =
          !is_known(known, from) &&
          (is_known(known, to) || (edge.in_m > 0.0F && edge.in_m < min(edge.out_m, length_m)));
      if (comes_in) expect_from(index, start_m + clamp(edge.in_m, 0.0F, length_m), reach);
      start_m = start_m + length_m;
    }
    const bool ends_known = is_known(known, lane.points[lane.point_count - 1]);
    for (const LaneIndex next : lane.successors) {
      if (next < 0 || next >= kMaxLanes || !scene::usable(map.lanes[next])) continue;
      // A gap between two lanes may lie on the edge.
      const bool gap = !ends_known && is_known(known, map.lanes[next].points[0]);
      if (gap) expect_from(next, 0.0F, reach);
    }
  }
  if (map.lanes_left_out == 0) return;
  work_ += kLedIntoWork;
  bool led_into[kMaxLanes];
  scene::find_led_into(map, led_into);
  for (LaneIndex index = 0; index < kMaxLanes; ++index) {
    const Lane& lane = map.lanes[index];
    if (work_ > most) return expect_everywhere();
    if (led_into[index] || !scene::usable(lane) || !is_known(known, lane.points[0])) continue;
    // By a lane we do not know, straight from the edge.
    expect_from(index, distance(lane.points[0], known.centre) - known.radius_m, reach);
  }
}

void Guard::expect_everywhere() {
  for (PathContext& context : contexts_) {
    context.too_many = true;
    expect_beside(context);
  }
}

void Guard::expect_beside(PathContext& context) const {
  context.behind.clear();
  (void)context.behind.push({kUnseen, 0, context.start_s_m + front_m_, start_.speed_mps});
}

// Whoever is missing `x` beyond the edge is no faster than we by more than x / kListLeadS, or it would be in the list. In the
// time t it comes x (t / kListLeadS - 1) + a t^2 / 2 further than we would: no further than either who is as fast as we at
// the edge or, later, who is at the fastest speed already, by v faster and v kListLeadS - a kListLeadS^2 / 2 beyond.
void Guard::expect_from(LaneIndex lane, float edge_s_m, const LaneReach (&reach)[kMaxTracks]) {
  scene::Agent somebody;
  somebody.track.length_m = kLengthM;
  somebody.age_ms = scene_->known.age_ms;
  somebody.lane = lane;
  scene::LanePath lane_path;
  (void)lane_path.lanes.push({lane, 0.0F});
  (void)somebody.paths.push(lane_path);
  somebody.frenet[0].s_m = edge_s_m;
  LaneReach anyhow;
  LaneReach straight_on;
  work_ += anyhow.measure(*scene_->map, somebody) + straight_on.measure(*scene_->map, somebody, false);
  expect(somebody, ThreatKind::kAlike, anyhow, straight_on, reach);
  const float faster_mps = unseen_mps(lane, ThreatKind::kComes) - unseen_mps(lane, ThreatKind::kAlike);
  const float back_m = faster_mps * kListLeadS - 0.5F * parameters_->law.gain_mps2 * square(kListLeadS);
  anyhow.move_back(max(back_m, 0.0F));
  straight_on.move_back(max(back_m, 0.0F));
  expect(somebody, ThreatKind::kComes, anyhow, straight_on, reach);
}

float Guard::unseen_mps(LaneIndex lane, ThreatKind kind) const {
  const float fastest_mps = parameters_->law.over_limit * scene_->map->lanes[lane].speed_limit_mps;
  return kind == ThreatKind::kAlike ? min(norm(scene_->known.velocity), fastest_mps) : fastest_mps;
}

void Guard::expect(scene::Agent& somebody, ThreatKind kind, const LaneReach& anyhow,
                   const LaneReach& straight_on, const LaneReach (&reach)[kMaxTracks]) {
  const float speed_mps = unseen_mps(somebody.lane, kind);
  somebody.track.speed_mps = speed_mps;
  work_ += kExpectWork;
  for (int p = 0; p < scene_->ego_paths.size(); ++p) {
    const scene::EgoPath& path = scene_->ego_paths[p];
    PathContext& context = contexts_[p];
    work_ += kZoneWork * path.zones.size();
    for (int z = 0; z < path.zones.size(); ++z) {
      const scene::ConflictZone& zone = path.zones[z];
      Threat threat{static_cast<std::uint8_t>(z), kUnseen, somebody.lane, kind,
                    zone_occupancy(*scene_, somebody, zone.merging ? straight_on : anyhow, zone, lead_s_,
                                   *parameters_)};
      if (threat.when.claim != Claim::kMayCome) continue;
      threat.when.until_s = kNeverS;  // another one may follow
      work_ += kHeldWork * scene_->agents.size();
      if (!held_back(context, z, zone, straight_on, reach, threat.when))
        add_unseen(threat, zone.merging, context);
    }
    // In a lane we change into, behind us: where nobody is between.
    const float to_start_m = straight_on.to_start_m(path.path.lanes[0].lane);
    if (!context.changes || to_start_m >= kNoWayM || -to_start_m > path.frenet.s_m + centre_m_) continue;
    bool between = false;
    for (const InLane& other : context.behind) between = between || other.agent != kUnseen;
    if (between) continue;
    const float since_s = lead_s_ + 1e-3F * static_cast<float>(scene_->known.age_ms);
    keep_nearest(context.behind, {kUnseen, 0, -to_start_m + 0.5F * kLengthM + speed_mps * since_s, speed_mps},
                 context.start_s_m + centre_m_);
  }
}

void Guard::add_unseen(const Threat& threat, bool merging, PathContext& context) {
  for (Threat& known : context.threats) {
    if (known.zone != threat.zone || known.agent != kUnseen) continue;
    if (merging && known.kind != threat.kind) continue;
    const bool can_stop = known.when.can_stop && threat.when.can_stop;
    if (threat.when.from_s < known.when.from_s) known = threat;
    known.when.can_stop = can_stop;
    return;
  }
  if (!context.threats.push(threat)) context.too_many = true;
}

bool Guard::held_back(const PathContext& context, int zone, const scene::ConflictZone& ground,
                      const LaneReach& straight_on, const LaneReach (&reach)[kMaxTracks],
                      ZoneOccupancy& when) const {
  for (int i = 0; i < scene_->agents.size(); ++i) {
    const LaneIndex lane = scene_->agents[i].lane;
    if (lane == kNoLaneIndex || straight_on.to_start_m(lane) >= kNoWayM) continue;
    const float ahead_m = straight_on.to_start_m(lane) - reach[i].to_start_m(lane);
    const float to_entry_m = reach[i].to_start_m(ground.other_lane) + ground.other_entry_m;
    if (ahead_m <= 0.0F || to_entry_m <= 0.0F || to_entry_m >= when.to_entry_m) continue;
    if ((context.staying_out[zone] >> i & 1U) != 0) return true;
    for (const Threat& threat : context.threats) {
      if (threat.zone == zone && threat.agent == i) when.from_s = max(when.from_s, threat.when.from_s);
    }
  }
  return false;
}

void Guard::expect_ahead(const scene::EgoPath& path, PathContext& context) {
  if (context.leader != 255) return;
  const scene::KnownGround& known = scene_->known;
  const float centre_s_m = path.frenet.s_m + centre_m_;
  for (const scene::PathLane& part : path.path.lanes) {
    const Lane& lane = scene_->map->lanes[part.lane];
    work_ += 1 + kTwoAheadWork * lane.point_count / 2;
    float start_s_m = part.start_s_m;
    for (int i = 1; i < lane.point_count; ++i) {
      const Point from = lane.points[i - 1];
      const Point to = lane.points[i];
      const float length_m = distance(from, to);
      if (start_s_m + length_m > centre_s_m && !is_known(known, to)) {
        // The slower the further off, or it would be in the list.
        const float own_mps = norm(known.velocity);
        const float its_mps = min(own_mps, kListLeadS * parameters_->law.braking_max_mps2);
        const float stop_m = kListLeadS * (own_mps - its_mps) +
                             occupancy::stopping_way_m(its_mps, parameters_->law.braking_max_mps2);
        const float edge_s_m = start_s_m + clamp(cut(known, from, to).out_m, 0.0F, length_m);
        context.leader_stop_s_m = max(edge_s_m, centre_s_m) + stop_m - 0.5F * kLengthM;
        context.leader = kUnseen;
        context.leader_mps = 0.0F;
        return;
      }
      start_s_m = start_s_m + length_m;
    }
  }
}

}  // namespace s4tp::safety
