#include "algo/scene/agent_paths.hpp"

#include "algo/core/inline.hpp"
#include "algo/core/sort.hpp"

namespace s4tp::scene {
namespace {

constexpr float kAheadM = 110.0F;      // far enough for whoever reaches a zone in 7 s
constexpr float kStraightRad = 0.35F;  // less than this is not a turn
constexpr float kUTurnRad = 2.3F;
constexpr float kTurnPrior = 0.8F;  // relative to straight on
constexpr float kUTurnPrior = 0.1F;
constexpr float kTurnLateral = 4.0F;    // m/s^2, what drivers accept in a turn
constexpr float kTurnBraking = 4.0F;    // m/s^2, on the way to it
constexpr float kTooFastMps = 1.5F;     // scale: this much too fast for the turn makes it e times less likely
constexpr float kUnnoticedMps2 = 0.5F;  // a slowing weaker than this means nothing
constexpr float kSlowWithinM = 40.0F;   // near a junction speed tells who turns
constexpr float kRollingMps = 3.0F;     // below this it may just be starting, or waiting
constexpr float kUsualShare = 0.85F;    // of the limit, at least: the speed of who goes straight on
constexpr float kTooSlowMps = 2.5F;     // scale: this much slower makes it e times less likely
constexpr float kMostSlowMps = 5.0F;    // slower than usual, and ...
constexpr float kMostSlowingMps2 = 3.0F;  // ... slowing: more tells no more
constexpr float kMostExponent = 8.0F;
constexpr float kHintPerRad = 4.0F;  // of its heading, and per rad/s of its yaw rate
constexpr float kHintPerM = 0.7F;
constexpr float kHintsWithinM = 15.0F;  // heading, yaw rate and offset speak for what comes this soon
constexpr float kAmbiguousM = 1.0F;     // lanes this close may both be the one
constexpr float kAmbiguousRad = 0.5F;
constexpr float kFitRad = 0.2F;  // scale of what its heading, and its yaw rate in a second, miss a lane by
constexpr float kMostMisfit = 10.0F;
constexpr float kSeekM = 5.0F;             // each way of where it is along its path
constexpr float kChangeLateralMps = 0.4F;  // a clear lateral speed
constexpr float kChangeOffsetM = 0.8F;     // where it leads within a second
constexpr int kSteps = 3 * kMaxPathLanes;  // each step closes a chain or makes one longer

// Work (WorkMeter's units).
constexpr int kPathsWork = 40;
constexpr int kStepWork = 3;    // of a step, and ...
constexpr int kBranchWork = 8;  // ... of each branch there

// A chain under construction; its likelihood is relative to the others'.
struct LaneChain {
  LanePath path;
  float start_s_m = 0.0F;  // of the vehicle on the path's first lane
  float weight = 1.0F;
  bool open = true;
};

using LaneChains = BoundedVector<LaneChain, kPathsPerAgent>;

float mean_curvature(float turn_rad, float length_m) {
  return turn_rad / max(length_m, 1.0F);
}

// How the vehicle stands and moves relative to the lane it is on.
struct Situation {
  const Track& track;
  float heading_rad;  // relative to the lane
  float offset_m;     // left positive
  float candour;      // how much being slow tells: less where it has another reason for it
};

// Speed at which drivers enter a bend: the map's limit where it is lowered for it, else by the curvature.
float entry_speed(const Bend& bend, float limit_mps) {
  const float curvature_1pm = max(abs(mean_curvature(bend.turn_rad, bend.length_m)), 1e-3F);
  const float by_curve_mps = sqrt(kTurnLateral / curvature_1pm);
  return bend.speed_limit_mps < limit_mps ? max(by_curve_mps, bend.speed_limit_mps) : by_curve_mps;
}

// Likelihood of entering a bend `distance_m` ahead from a lane of the given limit.
float branch_weight(const Bend& bend, float limit_mps, float distance_m, const Situation& situation) {
  const Track& track = situation.track;
  const float turn_rad = abs(bend.turn_rad);
  const bool turns = turn_rad > kStraightRad;
  const float speed_mps = track.speed_mps;
  float exponent = 0.0F;
  if (turns) {
    const float entry_mps = entry_speed(bend, limit_mps);
    const float possible_mps = sqrt(square(entry_mps) + 2.0F * kTurnBraking * max(distance_m, 0.0F));
    exponent -= max(speed_mps - possible_mps, 0.0F) / kTooFastMps;
  } else if (speed_mps > kRollingMps && track.acceleration_mps2 < 0.5F && distance_m < kSlowWithinM) {
    // Who slows down without being made to, or has, rather turns.
    const float slowness = clamp(kUsualShare * limit_mps - speed_mps, 0.0F, kMostSlowMps) / kTooSlowMps;
    const float slowing = clamp(-track.acceleration_mps2 - kUnnoticedMps2, 0.0F, kMostSlowingMps2);
    exponent -= situation.candour * (slowness + slowing);
  }
  if (distance_m < kHintsWithinM) {
    const float hint = clamp(kHintPerRad * track.yaw_rate_radps + kHintPerRad * situation.heading_rad +
                                 kHintPerM * situation.offset_m,
                             -2.0F, 2.0F);
    const float nearness = 1.0F - max(distance_m, 0.0F) / kHintsWithinM;
    const float agreement = turns ? (bend.turn_rad > 0.0F ? hint : -hint) : -abs(hint);
    exponent += nearness * agreement;
  }
  const float prior = turn_rad > kUTurnRad ? kUTurnPrior : (turns ? kTurnPrior : 1.0F);
  return prior * exp(clamp(exponent, -kMostExponent, kMostExponent));
}

// Likelihood of already being on a lane that starts or runs together with another.
float fit_weight(const LaneTable& table, const LaneFit& fit, const Track& track) {
  const LaneFacts& facts = table.facts(fit.lane);
  const float yaw_miss =
      track.yaw_rate_radps - track.speed_mps * mean_curvature(facts.turn_rad, facts.length_m);
  const float misfit =
      square(fit.fix.distance_m / 0.5F) + square(fit.turn_rad / kFitRad) + square(yaw_miss / kFitRad);
  return exp(clamp(-0.5F * misfit, -kMostMisfit, 0.0F));
}

// Whether one continues the other, or both end in the same lane: not another path.
bool same_path(const LaneTable& table, LaneIndex a, LaneIndex b) {
  for (LaneIndex of_a : table.lane(a).successors) {
    if (of_a == b) return true;
    for (LaneIndex of_b : table.lane(b).successors) {
      if (of_b == a || (of_a == of_b && of_a != kNoLaneIndex)) return true;
    }
  }
  return false;
}

void start_chain(const LaneTable& table, LaneIndex lane, float start_s_m, float weight, LaneChains& chains) {
  LaneChain chain;
  chain.start_s_m = start_s_m;
  chain.weight = weight;
  if (table.append(chain.path, lane)) (void)chains.push(chain);
}

// The lane a change under way leads to, or kNoLaneIndex. A junction's lanes have no neighbours: there it is the one that
// the vehicle will soon be nearer to than to its own.
LaneIndex change_target(const LaneTable& table, const LaneTable::Fits& fits, const Situation& situation) {
  const Lane& lane = table.lane(fits[0].lane);
  const float lateral_mps = situation.track.speed_mps * sin(situation.heading_rad);
  const float soon_m = situation.offset_m + lateral_mps;
  const bool leaves = lateral_mps > 0.0F ? soon_m > kChangeOffsetM : soon_m < -kChangeOffsetM;
  if (abs(lateral_mps) < kChangeLateralMps || !leaves) return kNoLaneIndex;
  if (!lane.in_junction) {
    const LaneIndex beside = lateral_mps > 0.0F ? lane.left : lane.right;
    return table.valid(beside) && beside != fits[0].lane ? beside : kNoLaneIndex;
  }
  const Pose& here = situation.track.centre;
  const Pose along{here.x_m, here.y_m, here.heading_rad - situation.heading_rad};
  const Point soon = offset_point(along, 0.0F, lateral_mps);
  LaneTable::Fits near_soon;
  table.fit({soon.x_m, soon.y_m, here.heading_rad}, {}, near_soon);
  LaneIndex target = kNoLaneIndex;
  float nearest_m = abs(soon_m);
  for (const LaneFit& fit : near_soon) {
    if (abs(fit.turn_rad) > kAmbiguousRad || same_path(table, fits[0].lane, fit.lane)) continue;
    if (fit.fix.distance_m >= nearest_m) continue;
    nearest_m = fit.fix.distance_m;
    target = fit.lane;
  }
  return target;
}

// Makes the shortest open chain longer, in as many chains as there is room for.
void extend(const LaneTable& table, const Situation& situation, LaneChains& chains) {
  int shortest = -1;
  for (int i = 0; i < chains.size(); ++i) {
    if (!chains[i].open) continue;
    if (shortest < 0 || chains[i].path.length_m - chains[i].start_s_m <
                            chains[shortest].path.length_m - chains[shortest].start_s_m) {
      shortest = i;
    }
  }
  if (shortest < 0) return;
  table.spend(kStepWork);
  const LaneChain trunk = chains[shortest];
  chains[shortest].open = false;
  const float distance_m = trunk.path.length_m - trunk.start_s_m;
  if (distance_m >= kAheadM) return;

  struct Branch {
    LaneIndex lane;
    float weight;
  };
  BoundedVector<Branch, kMaxSuccessors> branches;
  float sum = 0.0F;
  const LaneIndex end = trunk.path.lanes[trunk.path.lanes.size() - 1].lane;
  for (LaneIndex successor : table.lane(end).successors) {
    if (!table.valid(successor)) continue;
    table.spend(kBranchWork);
    const Branch branch{successor, branch_weight(table.bend(successor), table.lane(end).speed_limit_mps,
                                                 distance_m, situation)};
    sum += branch.weight;
    insert(branches, branch, [](const Branch& a, const Branch& b) { return a.weight > b.weight; });
  }
  bool first = true;
  for (const Branch& branch : branches) {
    LaneChain chain = trunk;
    chain.weight = trunk.weight * (branch.weight / sum);
    if (!table.append(chain.path, branch.lane)) continue;
    if (first) {
      chains[shortest] = chain;
    } else {
      (void)chains.push(chain);  // no room: the unlikely ones are left out
    }
    first = false;
  }
}

}  // namespace

void build_agent_paths(const LaneTable& table, bool hindered, Agent& agent) {
  const Track& track = agent.track;
  agent.paths.clear();
  LaneTable::Fits fits;
  table.fit(track.centre, {agent.lane, false}, fits);
  agent.lane = fits.empty() ? kNoLaneIndex : fits[0].lane;
  if (fits.empty()) return;

  LaneChains chains;
  start_chain(table, agent.lane, fits[0].fix.s_m, 1.0F, chains);
  int work = kPathsWork;
  const Frenet here =
      project(table.map(), chains[0].path, position(track.centre), fits[0].fix.s_m, kSeekM, work);
  // Others in front explain all, a stop line part: it may be there for who turns.
  const float candour = hindered ? 0.0F : (table.lane(agent.lane).stop_line_m >= 0.0F ? 0.5F : 1.0F);
  const Situation situation{track, wrap_angle(track.centre.heading_rad - here.heading_rad), here.d_m,
                            candour};
  const LaneIndex target = change_target(table, fits, situation);
  if (target != kNoLaneIndex) {
    const LaneFix fix = nearest_on_lane(table.lane(target), position(track.centre));
    start_chain(table, target, fix.s_m, 2.0F, chains);
  }
  // Where lanes branch it may be on any of those that lie together here.
  chains[0].weight = fit_weight(table, fits[0], track);
  for (int i = 1; i < fits.size(); ++i) {
    const LaneFit& fit = fits[i];
    const bool together = fit.fix.distance_m < kAmbiguousM && abs(fit.turn_rad) < kAmbiguousRad;
    if (!together || fit.lane == target || same_path(table, agent.lane, fit.lane)) continue;
    start_chain(table, fit.lane, fit.fix.s_m, fit_weight(table, fit, track), chains);
  }
  if (target != kNoLaneIndex) chains[1].weight *= chains[0].weight;
  for (int step = 0; step < kSteps; ++step) extend(table, situation, chains);

  // Likeliest first; in one order for equals.
  float sum = 0.0F;
  for (const LaneChain& chain : chains) sum += chain.weight;
  sort(chains, [](const LaneChain& a, const LaneChain& b) { return a.weight > b.weight; });
  for (int i = 0; i < chains.size(); ++i) {
    (void)agent.paths.push(chains[i].path);
    agent.path_probability[i] = chains[i].weight / sum;
    constexpr float kReachM = 15.0F;
    agent.frenet[i] =
        project(table.map(), chains[i].path, position(track.centre), chains[i].start_s_m, kReachM, work);
  }
  table.spend(work);
}

void bring_forward(const LaneMap* map, float seconds, Agent& agent) {
  Track& track = agent.track;
  const float stop_s = track.acceleration_mps2 < 0.0F ? -track.speed_mps / track.acceleration_mps2 : 1e3F;
  const float moving_s = min(seconds, stop_s);
  const float travel_m =
      max(track.speed_mps * moving_s + 0.5F * track.acceleration_mps2 * square(moving_s), 0.0F);
  const float later_mps = max(track.speed_mps + track.acceleration_mps2 * moving_s, 0.0F);
  agent.coasted_m = travel_m;
  agent.coasted_mps = later_mps - track.speed_mps;
  track.speed_mps = later_mps;
  if (map == nullptr || agent.paths.empty()) {
    const float turn_rad = track.yaw_rate_radps * moving_s;
    track.centre.heading_rad = wrap_angle(track.centre.heading_rad + 0.5F * turn_rad);
    track.centre = shift_ahead(track.centre, travel_m);
    track.centre.heading_rad = wrap_angle(track.centre.heading_rad + 0.5F * turn_rad);
    return;
  }
  const float off_rad = wrap_angle(track.centre.heading_rad - agent.frenet[0].heading_rad);
  const SinCos off = sin_cos(off_rad);
  const LaneIndex lane_before = agent.lane;
  for (int i = 0; i < agent.paths.size(); ++i) {
    Frenet& frenet = agent.frenet[i];
    frenet.s_m += travel_m * off.cos;
    frenet.d_m += travel_m * off.sin;
    const PathPoint point = path_point(*map, agent.paths[i], frenet.s_m);
    frenet.heading_rad = point.pose.heading_rad;
    const bool same_lane = agent.paths[i].lanes[0].lane == lane_before && agent.lane == lane_before;
    if (same_lane) agent.lane = point.lane;
    if (i > 0) continue;
    const Point centre = offset_point(point.pose, 0.0F, frenet.d_m);
    track.centre = {centre.x_m, centre.y_m, wrap_angle(point.pose.heading_rad + off_rad)};
  }
}

bool arc_length_on(const LanePath& path, const Agent& agent, float& s_m) {
  for (int i = 0; i < agent.paths.size(); ++i) {
    const LanePath& own = agent.paths[i];
    for (int k = 0; k < own.lanes.size(); ++k) {
      // The lane it is on, or the one it is changing to: there its chain begins.
      if (own.lanes[k].lane != agent.lane && k > 0) continue;
      for (const PathLane& part : path.lanes) {
        if (part.lane != own.lanes[k].lane) continue;
        s_m = part.start_s_m + agent.frenet[i].s_m - own.lanes[k].start_s_m;
        return true;
      }
    }
  }
  return false;
}

}  // namespace s4tp::scene
