#include "algo/sadrf/overlap.hpp"

#include "algo/core/inline.hpp"
#include "algo/trajectory/bicycle.hpp"

namespace s4tp::sadrf {
namespace {

constexpr float kDeeperM = 0.3F;       // boxes that touch from the start count once this much deeper
constexpr float kRoundingM = 0.01F;    // more than what rounding can change in a distance within reach
constexpr std::int32_t kLookWork = 2;  // WorkMeter's units
constexpr float kShareKept = 0.5F;     // of a gap that was below the margin from the start

/// Our boxes along a trajectory, made as they are needed, for looks at many futures.
class OwnBoxes {
 public:
  OwnBoxes(const Trajectory& trajectory, const Parameters& parameters)
      : trajectory_(trajectory),
        vehicle_(parameters.vehicle),
        centre_m_(trajectory::rear_axle_to_centre_m(parameters)) {
    float longest_m2 = 0.0F;
    for (int i = 1; i < kTrajectoryPoints; ++i) {
      const Point moved = rear_axle(i) - rear_axle(i - 1);
      longest_m2 = max(longest_m2, dot(moved, moved));
    }
    longest_step_m_ = sqrt(longest_m2);
  }

  /// At trajectory point `point`.
  [[nodiscard]] Point rear_axle(int point) const { return position(trajectory_.points[point].rear_axle); }
  /// From one point to the next at most.
  [[nodiscard]] float longest_step_m() const { return longest_step_m_; }
  /// From rear axle to the other's box centre, and above both half diagonals.
  [[nodiscard]] float reach_m(const Track& other, float margin_m) const {
    return abs(centre_m_) + margin_m +
           0.5F * (vehicle_.length_m + vehicle_.width_m + other.length_m + other.width_m);
  }

  /// Separation at trajectory point `point`, or something smaller that is more than `enough_m`.
  /// \param half_diagonal_m  of the other
  [[nodiscard]] float separation_from(const Box& other, float half_diagonal_m, float enough_m, int point) {
    if ((known_ >> point & 1U) == 0) {
      known_ |= 1U << point;
      turned_[point] = sin_cos(trajectory_.points[point].rear_axle.heading_rad);
    }
    const Point ahead = {turned_[point].cos, turned_[point].sin};
    const Point centre = rear_axle(point) + centre_m_ * ahead;
    const Point offset = position(other.centre) - centre;
    // However it is turned, it reaches no further along our axes than its half diagonal.
    const float along_m = abs(dot(ahead, offset)) - 0.5F * vehicle_.length_m;
    const float across_m = abs(cross(ahead, offset)) - 0.5F * vehicle_.width_m;
    float least_m = max(along_m, across_m) - half_diagonal_m - kRoundingM;
    if (least_m > enough_m) return least_m;
    least_m = separation_bound(along_m, across_m, other, trajectory_.points[point].rear_axle.heading_rad);
    if (least_m > enough_m) return least_m;
    const Box own = {{centre.x_m, centre.y_m, 0.0F}, vehicle_.length_m, vehicle_.width_m};
    return separation(own, ahead, other, direction(other.centre.heading_rad));
  }

 private:
  /// What the boxes are apart at least along our axes, without a sine: sin x <= x is all but equal where the
  /// boxes are nearly parallel or at right angles, which boxes of cars mostly are.
  static float separation_bound(float along_m, float across_m, const Box& other, float heading_rad) {
    const float turned_rad = abs(wrap_angle(other.centre.heading_rad - heading_rad));
    const float from_parallel_rad = min(turned_rad, kPi - turned_rad);
    const float sine = min(from_parallel_rad, 1.0F);
    const float cosine = min(0.5F * kPi - from_parallel_rad, 1.0F);
    const float half_length_m = 0.5F * other.length_m;
    const float half_width_m = 0.5F * other.width_m;
    const float reach_along_m = half_length_m * cosine + half_width_m * sine;
    const float reach_across_m = half_length_m * sine + half_width_m * cosine;
    return max(along_m - reach_along_m, across_m - reach_across_m) - kRoundingM;
  }

  const Trajectory& trajectory_;
  const decltype(Parameters::vehicle)& vehicle_;
  float centre_m_;
  float longest_step_m_;
  std::uint32_t known_ = 0;  ///< a bit a point
  SinCos turned_[kTrajectoryPoints];
};
static_assert(kTrajectoryPoints <= 32);

/// \param looks  out: steps that were looked at closely
int first_collision(OwnBoxes& own, const satp::Mode& mode, const Track& track, int steps, float margin_m,
                    int& looks) {
  const float reach_m = own.reach_m(track, margin_m);
  const float half_diagonal_m = 0.5F * norm({track.length_m, track.width_m});
  const float closing_m = own.longest_step_m() + 0.01F * static_cast<float>(mode.longest_step_cm);
  constexpr int kFarSteps = 12;
  constexpr int kNearSteps = 3;
  const float far_m = reach_m + kRoundingM + static_cast<float>(kFarSteps) * closing_m;
  const float near_m = reach_m + kRoundingM + static_cast<float>(kNearSteps) * closing_m;
  float least_m = margin_m;
  for (int i = 0; i < steps && i < kHorizonSteps; ++i) {
    const Point apart = own.rear_axle(i + 1) - position(mode.steps[i]);
    const float apart_m2 = dot(apart, apart);
    if (apart_m2 > square(reach_m)) {
      // So far apart they stay out of reach for some steps to come.
      i += apart_m2 > square(far_m) ? kFarSteps : (apart_m2 > square(near_m) ? kNearSteps : 0);
      continue;
    }
    const Box box = {mode.steps[i], track.length_m, track.width_m};
    ++looks;
    const float gap_m = own.separation_from(box, half_diagonal_m, least_m, i + 1);
    if (gap_m >= least_m) continue;
    if (i > 0) return i;
    // So near already, and nothing can be done about the first step: it must not get much worse.
    least_m = gap_m > 0.0F ? kShareKept * gap_m : gap_m - kDeeperM;
  }
  return -1;
}

}  // namespace

int first_collision(const Trajectory& trajectory, const satp::Mode& mode, const Track& track, int steps,
                    float margin_m, const Parameters& parameters) {
  OwnBoxes own(trajectory, parameters);
  int looks = 0;
  return first_collision(own, mode, track, steps, margin_m, looks);
}

float expected_collisions(const scene::Scene& scene, const satp::PredictionSet& prediction,
                          const Trajectory& trajectory, const Parameters& parameters, WorkMeter& work) {
  OwnBoxes own(trajectory, parameters);
  float expected = 0.0F;
  int looks = 0;
  for (const satp::AgentPrediction& predicted : prediction.agents) {
    const Track& track = scene.agents[predicted.agent].track;
    for (const satp::Mode& mode : predicted.modes) {
      if (first_collision(own, mode, track, kHorizonSteps, 0.0F, looks) >= 0)
        expected = expected + mode.probability;
    }
  }
  work.spend(kLookWork * looks);
  return expected;
}

}  // namespace s4tp::sadrf
