// Whoever is behind us in a lane we come into: what room it has to brake, however we stop.
#include "algo/core/inline.hpp"
#include "algo/core/standing.hpp"
#include "algo/safety/guard.hpp"
#include "algo/safety/guard_own.hpp"

namespace s4tp::safety {
namespace {

/// A fail-safe after a lane change: how long the plan is driven on, and how much of the braking then follows.
struct Settling {
  float drives_on_s;
  float share;
};
constexpr Settling kSettlings[] = {{2.0F, 1.0F}, {0.0F, 1.0F}, {0.0F, 0.6F}, {0.0F, 0.35F}};
constexpr int kSettlingCount = static_cast<int>(sizeof(kSettlings) / sizeof(kSettlings[0]));
constexpr float kMuchRoomM = 1000.0F;  // behind us

}  // namespace

FailSafe Guard::in_force() const {
  const auto& guard = parameters_->guard;
  if (!(fail_safe_.braking_mps2 > 0.0F)) return {guard.takeover_s, guard.braking_mps2};
  const float driven_s =
      1e-3F * static_cast<float>(static_cast<std::int32_t>(scene_->time_ms - start_ms_)) + lead_s_;
  return {clamp(fail_safe_.branch_s - driven_s, guard.takeover_s, kHorizonS), fail_safe_.braking_mps2};
}

FailSafe Guard::stop_after_change(int index) const {
  static_assert(kStopCount == kSettlingCount + 1, "and the one in force");
  if (index == kSettlingCount) return in_force();
  const auto& guard = parameters_->guard;
  const Settling& settling = kSettlings[index];
  return {max(guard.takeover_s, settling.drives_on_s), settling.share * guard.braking_mps2};
}

float Guard::room_behind_m(const PathContext& context, const InLane& behind, const Own& own,
                           const FailSafe& stop, const Between& between) const {
  const auto& rss = parameters_->rss;
  const float to_rear_m = 0.5F * parameters_->vehicle.length_m + parameters_->guard.margin_m;
  // Until we are over the line it gains speed as it may; then it has its response time, and brakes down to our speed.
  const float from_s = max(0.0F, between.from_s + rss.response_s);
  float s_m = behind.bumper_s_m;
  float speed_mps = behind.speed_mps;
  float own_s_m = own.s_m[0] - to_rear_m;
  float own_mps = own.speed_mps[0];
  float least_m = kMuchRoomM;
  constexpr float kLookS = 0.2F;
  constexpr int kLooks = 25;
  for (int i = 1; i <= kLooks; ++i) {
    const float time_s = static_cast<float>(i) * kLookS;
    if (time_s > between.until_s) break;
    if (time_s <= stop.branch_s) {
      own_s_m = own.place_at_m(time_s, 0.0F) - to_rear_m;
      own_mps = own.speed_at_mps(time_s, 0.0F);
    } else {
      const float later_mps = max(0.0F, own_mps - stop.braking_mps2 * kLookS);
      own_s_m = own_s_m + 0.5F * (own_mps + later_mps) * kLookS;
      own_mps = later_mps;
    }
    const float gained_mps =
        min(speed_mps + parameters_->law.gain_mps2 * kLookS, max(speed_mps, context.fastest_mps));
    const float later_mps =
        time_s > from_s ? max(0.0F, speed_mps - rss.braking_min_mps2 * kLookS) : gained_mps;
    s_m = s_m + 0.5F * (speed_mps + later_mps) * kLookS;
    speed_mps = later_mps;
    if (time_s < between.from_s) continue;
    least_m = min(least_m, own_s_m - s_m);
    if (speed_mps <= 0.0F) break;
  }
  return least_m;
}

void Guard::find_lacking(float reaches_in_m, PathContext& context) const {
  const bool is_in = context.changes ? reaches_in_m > 0.0F : context.settles && change_.over;
  if (!is_in || context.behind.empty()) return;
  const Between between{context.changes ? 0.0F : -changing_s()};
  Own own;  // as we drive now: the fail-safe in force is that of such a plan
  own.s_m[0] = context.start_s_m + centre_m_;
  own.speed_mps[0] = start_.speed_mps;
  for (int i = 1; i < kTrajectoryPoints; ++i) {
    own.speed_mps[i] = max(0.0F, own.speed_mps[i - 1] + start_.acceleration_mps2 * kStepS);
    own.s_m[i] = own.s_m[i - 1] + own.speed_mps[i] * kStepS;
  }
  for (InLane& behind : context.behind) {
    const bool beside = behind.bumper_s_m > own.s_m[0] - 0.5F * parameters_->vehicle.length_m;
    if (behind.agent == kUnseen || behind.speed_mps < kStandingMps || beside) continue;
    float most_m = room_behind_m(context, behind, own, stop_after_change(0), between);
    for (int k = 1; k < kStopCount && most_m < 0.0F; ++k)
      most_m = max(most_m, room_behind_m(context, behind, own, stop_after_change(k), between));
    behind.lacks_cm = static_cast<std::int16_t>(to_int(-100.0F * most_m, 0, 10'000));
  }
}

bool Guard::followers_can_brake(const PathContext& context, const Trajectory& trajectory, const Own& own,
                                const FailSafe& stop, const Between& between, Verdict& verdict) const {
  for (const InLane& behind : context.behind) {
    // Whoever stands needs no room to brake, only that our box keeps off it. Who lacks room however we stop is left no less.
    const bool keeps_off = behind.agent != kUnseen && behind.speed_mps < kStandingMps
                               ? way_over_ends_s_m(behind.agent, trajectory, own) >= trajectory::kNoDeadEndM
                               : room_behind_m(context, behind, own, stop, between) >=
                                     -0.01F * static_cast<float>(behind.lacks_cm);
    if (keeps_off) continue;
    verdict.cause = Cause::kFollower;
    verdict.agent = behind.agent;
    return false;
  }
  return true;
}

}  // namespace s4tp::safety
