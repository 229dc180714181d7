#include "algo/scene/lane_table.hpp"

#include "algo/core/inline.hpp"
#include "algo/core/sort.hpp"

namespace s4tp::scene {
namespace {

constexpr float kBesideM = 1.0F;    // a vehicle this far over the lane's edge still belongs to it
constexpr float kSwungOutM = 2.5F;  // the ego, over that of the lane it comes along: as far as a turn leads
constexpr float kHeadingLimitRad = 1.05F;  // 60 degrees
constexpr float kTurnedOutRad = 1.75F;     // 100: of the lane the ego comes along, which turns before it does
constexpr float kAheadM = 40.0F;           // before a lane's start it still is our way
constexpr float kAheadRad = 0.2F;
constexpr int kJunctionParts = 4;       // lanes one way across a junction is cut into, at most
constexpr float kHeadingWeight = 0.5F;  // m/rad
constexpr float kStayM = 0.6F;          // hysteresis: changes over 0.3 m beyond the middle
constexpr float kGoOnM = 0.3F;          // the same for a successor of the previous lane
constexpr float kPerChangeM = 0.05F;    // where lanes part, ours is the one that needs fewer changes
constexpr float kOffRouteM = 1.0F;
constexpr float kNotOursM = 2.0F;

// Work (WorkMeter's units).
constexpr int kTableWork = 60;
constexpr int kFitWork = 12;  // to see which lanes are near, and ...
constexpr int kNearWork = 5;  // ... of each that is

LaneFacts work_out(const Lane& lane) {
  LaneFacts facts;
  facts.usable = usable(lane);
  if (!facts.usable) return facts;
  facts.length_m = centre_line_length(lane);
  facts.low = lane.points[0];
  facts.high = lane.points[0];
  for (int i = 1; i < lane.point_count; ++i) {
    facts.low = {min(facts.low.x_m, lane.points[i].x_m), min(facts.low.y_m, lane.points[i].y_m)};
    facts.high = {max(facts.high.x_m, lane.points[i].x_m), max(facts.high.y_m, lane.points[i].y_m)};
  }
  if (lane.point_count > 2) {
    const Point first = lane.points[1] - lane.points[0];
    const Point last = lane.points[lane.point_count - 1] - lane.points[lane.point_count - 2];
    facts.turn_rad = atan2(cross(first, last), dot(first, last));
  }
  return facts;
}

bool follows(const Lane& before, LaneIndex lane) {
  for (LaneIndex successor : before.successors) {
    if (successor == lane) return true;
  }
  return false;
}

}  // namespace

LaneTable::LaneTable(const LaneMap* map) : map_(map) {
  if (map == nullptr) return;
  int vertices = 0;
  for (int i = 0; i < kMaxLanes; ++i) {
    facts_[i] = work_out(map->lanes[i]);
    vertices += facts_[i].usable ? map->lanes[i].point_count : 0;
  }
  spend(kTableWork + vertices);
}

Bend LaneTable::bend(LaneIndex index) const {
  Bend bend{facts_[index].turn_rad, facts_[index].length_m, map_->lanes[index].speed_limit_mps};
  for (int part = 1; part < kJunctionParts && map_->lanes[index].in_junction; ++part) {
    const LaneIndex next = map_->lanes[index].successors[0];
    if (!valid(next) || !map_->lanes[next].in_junction) break;
    index = next;
    bend.turn_rad += facts_[index].turn_rad;
    bend.length_m += facts_[index].length_m;
    bend.speed_limit_mps = min(bend.speed_limit_mps, map_->lanes[index].speed_limit_mps);
  }
  return bend;
}

bool LaneTable::valid(LaneIndex index) const {
  return index >= 0 && index < kMaxLanes && facts_[index].usable;
}

void LaneTable::fit(const Pose& pose, const LaneHint& hint, Fits& fits) const {
  fits.clear();
  spend(kFitWork);
  for (int i = 0; i < kMaxLanes; ++i) {
    const LaneFacts& facts = facts_[i];
    if (!facts.usable) continue;
    const Lane& lane = map_->lanes[i];
    const bool stays = i == hint.previous;
    const bool goes_on =
        valid(hint.previous) && follows(map_->lanes[hint.previous], static_cast<LaneIndex>(i));
    const bool may_swing_out = hint.follows_route && (stays || goes_on);
    const float limit_m = 0.5F * lane.width_m + (may_swing_out ? kSwungOutM : kBesideM);
    const float limit_rad = may_swing_out ? kTurnedOutRad : kHeadingLimitRad;
    if (pose.x_m < facts.low.x_m - limit_m || pose.x_m > facts.high.x_m + limit_m ||
        pose.y_m < facts.low.y_m - limit_m || pose.y_m > facts.high.y_m + limit_m) {
      continue;
    }
    spend(kNearWork);
    LaneFit found;
    found.lane = static_cast<LaneIndex>(i);
    found.fix = nearest_on_lane(lane, position(pose));
    found.turn_rad = wrap_angle(pose.heading_rad - found.fix.heading_rad);
    if (found.fix.distance_m > limit_m || abs(found.turn_rad) > limit_rad) continue;
    found.score = found.fix.distance_m + kHeadingWeight * abs(found.turn_rad);
    if (stays) {
      found.score -= kStayM;
    } else if (goes_on) {
      found.score -= kGoOnM;
    }
    if (hint.follows_route && !lane.on_route) found.score += kOffRouteM;
    if (hint.follows_route) found.score += kPerChangeM * abs(static_cast<float>(lane.changes_needed));
    if (hint.follows_route && lane.kind != LaneKind::kOurs) found.score += kNotOursM;
    insert(fits, found, [](const LaneFit& a, const LaneFit& b) { return a.score < b.score; });
  }
}

LaneIndex LaneTable::lane_ahead(const Pose& pose) const {
  LaneIndex best = kNoLaneIndex;
  float nearest_m = kAheadM;
  for (int i = 0; i < kMaxLanes; ++i) {
    if (!facts_[i].usable) continue;
    const Lane& lane = map_->lanes[i];
    const Point start = to_local(pose, lane.points[0]);
    if (start.x_m < 0.0F || start.x_m >= nearest_m || abs(start.y_m) > 0.5F * lane.width_m) continue;
    const float turn_rad = wrap_angle(lane_segment(lane, 0).heading_rad - pose.heading_rad);
    if (abs(turn_rad) > kAheadRad) continue;
    best = static_cast<LaneIndex>(i);
    nearest_m = start.x_m;
  }
  return best;
}

bool LaneTable::append(LanePath& path, LaneIndex lane) const {
  if (is_along(path, lane) || !path.lanes.push({lane, path.length_m})) return false;
  path.length_m += facts_[lane].length_m;
  return true;
}

}  // namespace s4tp::scene
