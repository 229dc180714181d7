#pragma once
/// A small world along lines, for properties of the guard: an ego that drives any plan the guard passes, and
/// others who do the worst that the law leaves them.

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "algo/scene/track_memory.hpp"
#include "tests/support/lawful_driver.hpp"
#include "tests/support/shared_ground.hpp"

namespace s4tp::test {

struct Traffic {
  SharedGround road;
  std::mt19937 random;
  Mover ego;
  std::vector<Lawful> others;
  float time_s = 0.0F;
  float waited_s = 0.0F;
  bool touched_left_out = false;  ///< somebody who was left out before, when run() answers false
  float sight_m =
      scene::KnownGround::kEverywhereM;  ///< who is further, by list_distance_m, is left out of lists
  bool merging = false;
  bool committed = false;       ///< the plan in force goes through the zone
  float ego_entered_s = -1.0F;  ///< when it came into the zone
  std::vector<float> ahead;     ///< accelerations of the plan in force and its fail-safe, a tick each
  int passed = 0;
  int refused = 0;

  Traffic(Priority priority, bool merges, unsigned seed)
      : road(priority, merges), random(seed), merging(merges) {}

  float between(float low, float high) { return drawn_between(random, low, high); }
  bool chance(float share) { return between(0.0F, 1.0F) < share; }
  [[nodiscard]] bool we_yield() const {
    return road.scene.ego_paths[0].zones[0].priority != Priority::kFirstHasPriority;
  }

  [[nodiscard]] Pose pose_of(const Lawful& other) const {
    return state_on(road.map, other.leads ? road.ours : road.theirs, other.motion.s_m, 0.0F).rear_axle;
  }
  [[nodiscard]] Point place_of(const Lawful& other) const { return position(pose_of(other)); }
  [[nodiscard]] Pose own_pose() const { return state_on(road.map, road.ours, ego.s_m, 0.0F).rear_axle; }
  [[nodiscard]] Point own_place() const { return position(own_pose()); }
  [[nodiscard]] Point own_velocity() const { return ego.speed_mps * direction(own_pose().heading_rad); }
  [[nodiscard]] bool left_out(const Lawful& other) const {
    const Point velocity = other.motion.speed_mps * direction(pose_of(other).heading_rad);
    return scene::list_distance_m(distance(place_of(other), own_place()), norm(velocity - own_velocity())) >
           sight_m;
  }

  /// The scene as the planner is told it.
  void observe() {
    scene::Scene& scene = road.scene;
    scene.agents.clear();
    scene.known = {own_place(), sight_m, 0, std::uint8_t{sight_m < scene::KnownGround::kEverywhereM},
                   own_velocity()};
    for (Lawful& other : others) {
      if (left_out(other)) {
        other.was_left_out = true;
        continue;
      }
      scene::Agent& agent = add_vehicle(scene, road.map, other.leads ? road.ours : road.theirs,
                                        other.motion.s_m, other.motion.speed_mps);
      // Beyond the zone of a merge it is in our lane.
      if (merging && !other.leads && other.motion.s_m > kExitM) {
        scene.agents.truncate(scene.agents.size() - 1);
        add_vehicle(scene, road.map, road.ours, other.motion.s_m, other.motion.speed_mps);
      }
      agent.track.id = static_cast<std::uint8_t>(1 + (&other - others.data()));
      agent.track.acceleration_mps2 = other.motion.acceleration_mps2;
      agent.known_ms = static_cast<std::uint16_t>(1000.0F * std::min(other.known_s, 60.0F));
      agent.stood_ms = static_cast<std::uint16_t>(1000.0F * std::min(other.stood_s, 60.0F));
    }
    scene.waited_s = waited_s;
    scene.time_ms = static_cast<std::uint32_t>(std::lround(1000.0F * time_s));
  }

  /// A plan of two accelerations from the state the plan in force has in 0.1 s.
  [[nodiscard]] Trajectory plan(const Mover& start, float first_mps2, int steps, float then_mps2) const {
    Trajectory trajectory;
    Mover at = start;
    for (int i = 0; i < kTrajectoryPoints; ++i) {
      const float wanted_mps2 = i < steps ? first_mps2 : then_mps2;
      trajectory.points[i] = state_on(road.map, road.ours, at.s_m - 1.5F, at.speed_mps);
      at.drive(wanted_mps2, kStepS, kTopMps);
      trajectory.points[i].acceleration_mps2 = at.acceleration_mps2;
    }
    return trajectory;
  }

  bool try_plan(const Mover& start, float first_mps2, int steps, float then_mps2) {
    const Trajectory trajectory = plan(start, first_mps2, steps, then_mps2);
    const safety::Verdict verdict = road.guard.judge(0, trajectory);
    if (!verdict.safe()) return false;
    road.guard.commit(0, verdict);
    // It is driven until its fail-safe begins to brake; one that begins no sooner than the horizon's end, through the zone.
    ahead.resize(2);
    Mover at = start;
    const int branch = static_cast<int>(std::lround(verdict.fail_safe.branch_s / kTickS));
    for (int i = 0; i < 400; ++i) {
      const bool leaves = i >= branch && (branch < 2 * kHorizonSteps || at.s_m >= kExitM);
      const bool beyond = i / 2 >= kHorizonSteps;
      const float wanted_mps2 = leaves ? -6.0F : beyond ? 1.5F : i / 2 < steps ? first_mps2 : then_mps2;
      ahead.push_back(wanted_mps2);
      at.drive(wanted_mps2, kTickS, beyond ? kLimitMps : kTopMps);
    }
    if (verdict.clears && !committed) take_licences();
    if (!verdict.clears) drop_licences();
    committed = verdict.clears;
    return true;
  }

  void take_licences() {
    for (Lawful& other : others) {
      if (other.leads) continue;
      // The guard takes one that stands in the zone itself to stay where it is, too; in its first half after 2 s.
      const bool first_half = other.motion.s_m > kEntryM && other.motion.s_m < 0.5F * (kEntryM + kExitM);
      const float since_s = first_half && we_yield() ? 2.0F : 0.7F;
      if (!left_out(other) && other.stood_s >= since_s && waited_s >= since_s &&
          other.motion.acceleration_mps2 < 0.5F)
        other.stays = true;
      if (!we_yield() || other.to_entry_m() <= 0.0F || !other.can_be_asked()) continue;
      other.owed_mps2 = 2.0F;
      other.owed_from_s = time_s + 1.5F;
    }
  }
  void drop_licences() {
    for (Lawful& other : others) {
      other.stays = false;
      if (we_yield()) other.owed_mps2 = 0.0F;
    }
  }

  /// One planning cycle: any plan that passes, the first of some random ones and a few sober ones.
  void decide() {
    observe();
    Mover start = ego;
    start.drive(ahead[0], kTickS, kTopMps);
    start.drive(ahead[1], kTickS, kTopMps);
    TrajectoryPoint state = state_on(road.map, road.ours, ego.s_m - 1.5F, ego.speed_mps);
    put_ego(road.scene, state);
    state = state_on(road.map, road.ours, start.s_m - 1.5F, start.speed_mps);
    road.guard.look(road.scene, state, kStepS, road.parameters);
    // In the zone and before one who comes in behind we drive on: a stop there without reason is ours.
    const bool in_front = ego_entered_s >= 0.0F && (merging || ego.s_m < kExitM);
    for (int i = 0; i < 4; ++i) {
      const float first_mps2 = chance(0.3F) ? 3.5F : between(in_front ? 0.0F : -6.0F, 3.5F);
      const float then_mps2 = chance(0.3F) ? -6.0F : between(-6.0F, 3.5F);
      const int steps = chance(0.5F) ? 30 : static_cast<int>(between(0.0F, 20.0F));
      if (try_plan(start, first_mps2, in_front ? 30 : steps, then_mps2)) {
        ++passed;
        return;
      }
    }
    for (const float sober_mps2 : {0.0F, -2.0F, -4.0F, -6.0F, -8.0F, 2.0F, 3.5F}) {
      if (try_plan(start, sober_mps2, 30, 0.0F)) {
        ++passed;
        return;
      }
    }
    ++refused;
  }

  void tick() {
    const Lawful* in_front[2] = {nullptr, nullptr};
    for (std::size_t i = 0; i < others.size(); ++i) {
      for (const Lawful& candidate : others) {
        if (candidate.leads == others[i].leads && candidate.motion.s_m > others[i].motion.s_m)
          in_front[i] = &candidate;
      }
    }
    for (std::size_t i = 0; i < others.size(); ++i) {
      Lawful& other = others[i];
      if (!we_yield()) other.answer();
      other.drive({ego, time_s, merging, ego_entered_s, left_out(other)}, in_front[i], random);
      if (!left_out(other)) other.known_s += kTickS;
      other.stood_s = other.motion.speed_mps < 0.3F ? other.stood_s + kTickS : 0.0F;
    }
    ego.drive(ahead.front(), kTickS, kTopMps);
    ahead.erase(ahead.begin());
    const bool at_junction = ego.s_m > kEntryM - 17.0F && ego.s_m < kExitM;
    if (!at_junction) waited_s = 0.0F;
    if (at_junction && ego.speed_mps < 0.3F) waited_s += kTickS;
    time_s += kTickS;
    if (ego_entered_s < 0.0F && ego.s_m > kEntryM) {
      ego_entered_s = time_s;
    }
  }

  [[nodiscard]] bool touches(const Lawful& other) const {
    const Pose its =
        state_on(road.map, other.leads ? road.ours : road.theirs, other.motion.s_m, 0.0F).rear_axle;
    const Pose own = state_on(road.map, road.ours, ego.s_m, 0.0F).rear_axle;
    return overlap({own, 5.0F, 1.8F}, {its, 5.0F, 1.8F}, 0.0F);
  }

  /// We come from anywhere before the zone and could still stop there, and behind who leads us; the others
  /// from anywhere on their way.
  void place(int crossing, bool leader) {
    ego.s_m = between(10.0F, 95.0F);
    float free_m = kEntryM - 0.7F - ego.s_m;
    float s_m = chance(0.3F) ? between(80.0F, kEntryM) : between(20.0F, 110.0F);
    float speed_mps = chance(0.3F) ? 0.0F : between(0.0F, kTopMps);
    if (sight_m < scene::KnownGround::kEverywhereM && chance(0.7F)) {  // just left out, and fast
      const float across_m = 100.0F - ego.s_m;
      const float edge_m = std::sqrt(std::max(0.0F, sight_m * sight_m - across_m * across_m));
      s_m = 100.0F - edge_m - between(0.0F, 10.0F);
      speed_mps = between(10.0F, kLimitMps);
    }
    for (int i = 0; i < crossing; ++i) {
      Lawful other;
      other.motion.s_m = s_m;
      other.motion.speed_mps = speed_mps;
      others.push_back(other);
      s_m -= 6.0F + between(0.0F, 20.0F);  // the next one keeps its distance
      speed_mps = between(0.0F, speed_mps);
    }
    if (leader) {
      Lawful ahead_of_us;
      ahead_of_us.leads = true;
      ahead_of_us.motion.s_m = ego.s_m + 5.6F + between(0.0F, 60.0F);
      ahead_of_us.motion.speed_mps = chance(0.3F) ? 0.0F : between(0.0F, kTopMps);
      const float its_way_m = ahead_of_us.motion.speed_mps * ahead_of_us.motion.speed_mps / 16.0F;
      free_m = std::min(free_m, ahead_of_us.motion.s_m - ego.s_m - 5.5F + its_way_m);
      others.push_back(ahead_of_us);
    }
    for (Lawful& other : others) {
      if (left_out(other)) other.motion.speed_mps = std::min(other.motion.speed_mps, kLimitMps);
    }
    free_m = std::min(free_m, sight_m - 5.5F);
    // It takes 0.45 s until we brake with 6 m/s^2.
    const float most_mps = std::sqrt(2.7F * 2.7F + 12.0F * std::max(free_m, 0.0F)) - 2.7F;
    ego.speed_mps = chance(0.3F) ? 0.0F : std::min(most_mps, between(0.0F, kTopMps));
  }

  /// Drives for `duration_s`. \return false when we touched somebody, or it would have been ours
  bool run(float duration_s) {
    ahead.resize(8, 0.0F);  // as a plan before would have been left
    ahead.resize(200, -6.0F);
    for (int cycle = 0; static_cast<float>(cycle) * kStepS < duration_s; ++cycle) {
      decide();
      for (int i = 0; i < 2; ++i) {
        tick();
        for (const Lawful& other : others) {
          if (!touches(other)) continue;
          touched_left_out = other.was_left_out;
          return false;
        }
      }
      if (ahead.size() < 4) ahead.resize(100, -6.0F);
    }
    return true;
  }
};

}  // namespace s4tp::test
