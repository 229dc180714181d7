#include "algo/sadrf/overlap.hpp"

#include "algo/core/inline.hpp"
#include "algo/trajectory/bicycle.hpp"

namespace s4tp::sadrf {
namespace {

constexpr float kDeeperM = 0.3F;       // boxes that touch from the start count once this much deeper
constexpr float kRoundingM = 0.01F;    // more than what rounding can change in a distance within reach
constexpr float kAlongRad = 0.8F;      // one that follows heads so much like us
constexpr std::int32_t kLookWork = 2;  // WorkMeter's units

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
  [[nodiscard]] float reach_m(const Track& other) const {
    return abs(centre_m_) + 0.5F * (vehicle_.length_m + vehicle_.width_m + other.length_m + other.width_m);
  }

  /// What the boxes are apart at trajectory point `point`.
  [[nodiscard]] float gap_m(const Box& other, int point) const {
    const Pose centre = shift_ahead(trajectory_.points[point].rear_axle, centre_m_);
    return separation({centre, vehicle_.length_m, vehicle_.width_m}, other);
  }

  /// How likely the boxes touch at trajectory point `point`, if the other may be up to `off_m` further on or behind, any
  /// less by that much likelier. \param half_diagonal_m  of the other \param apart_m  to be added to what they are apart
  [[nodiscard]] float touch_likelihood(const Box& other, float half_diagonal_m, float off_m, float apart_m,
                                       int point) {
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
    const float far_m = off_m - apart_m + kRoundingM;
    if (max(along_m, across_m) - half_diagonal_m > far_m) return 0.0F;
    if (separation_bound(along_m, across_m, other, trajectory_.points[point].rear_axle.heading_rad) > far_m)
      return 0.0F;
    const Point there = direction(other.centre.heading_rad);
    const Pose own = {centre.x_m, centre.y_m, trajectory_.points[point].rear_axle.heading_rad};
    const AxisGaps gaps = axis_gaps({own, vehicle_.length_m, vehicle_.width_m}, ahead, other, there);
    // It is off along its own axis: that much of it along ours.
    const float lengthwise = abs(dot(ahead, there));
    const float crosswise = abs(cross(ahead, there));
    return min(min(closed(gaps.a_length_m + apart_m, lengthwise * off_m),
                   closed(gaps.a_width_m + apart_m, crosswise * off_m)),
               min(closed(gaps.b_length_m + apart_m, off_m), closed(gaps.b_width_m + apart_m, 0.0F)));
  }

 private:
  /// How likely what is off closes a gap: 1 where there is none, 0 where all of it does not.
  static float closed(float gap_m, float off_m) {
    if (gap_m <= 0.0F) return 1.0F;
    return gap_m < off_m ? 1.0F - gap_m / off_m : 0.0F;
  }

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
    return max(along_m - reach_along_m, across_m - reach_across_m);
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
float touch_likelihood(OwnBoxes& own, const satp::Mode& mode, const Track& track,
                       const Parameters& parameters, int& looks) {
  const float timing_error = parameters.scoring.timing_error;
  const float half_diagonal_m = 0.5F * norm({track.length_m, track.width_m});
  const float longest_m = 0.01F * static_cast<float>(mode.longest_step_cm);
  const float closing_m = own.longest_step_m() + longest_m;
  const float reach_m = own.reach_m(track) + timing_error * static_cast<float>(kHorizonSteps) * longest_m;
  constexpr int kFarSteps = 12;
  constexpr int kNearSteps = 3;
  const float far_m = reach_m + kRoundingM + static_cast<float>(kFarSteps) * closing_m;
  const float near_m = reach_m + kRoundingM + static_cast<float>(kNearSteps) * closing_m;
  float apart_m = 0.0F;
  float likeliest = 0.0F;
  for (int i = 0; i < kHorizonSteps && likeliest < 1.0F; ++i) {
    const Point between = own.rear_axle(i + 1) - position(mode.steps[i]);
    const float between_m2 = dot(between, between);
    if (between_m2 > square(reach_m)) {
      // So far apart they stay out of reach for some steps to come.
      i += between_m2 > square(far_m) ? kFarSteps : (between_m2 > square(near_m) ? kNearSteps : 0);
      continue;
    }
    const Box box = {mode.steps[i], track.length_m, track.width_m};
    ++looks;
    if (i == 0) {
      // Nothing can be done about the first step: of whoever touches us there it must not get much worse.
      const float gap_m = own.gap_m(box, 1);
      apart_m = gap_m > 0.0F ? 0.0F : kDeeperM - gap_m;
      continue;
    }
    const float step_m = distance(position(mode.steps[i]), position(mode.steps[i - 1]));
    const float off_m = timing_error * static_cast<float>(i + 1) * step_m;
    likeliest = max(likeliest, own.touch_likelihood(box, half_diagonal_m, off_m, apart_m, i + 1));
  }
  return likeliest;
}

/// Whether it is in our track behind us, heading as we do, where the trajectory begins.
bool follows_us(const Trajectory& trajectory, const Track& track, const Parameters& parameters) {
  const Pose& rear_axle = trajectory.points[0].rear_axle;
  const auto& vehicle = parameters.vehicle;
  const Point behind =
      to_local(shift_ahead(rear_axle, trajectory::rear_axle_to_centre_m(parameters)), position(track.centre));
  return behind.x_m < -0.5F * (vehicle.length_m + track.length_m) &&
         abs(behind.y_m) < 0.5F * (vehicle.width_m + track.width_m) &&
         abs(wrap_angle(track.centre.heading_rad - rear_axle.heading_rad)) < kAlongRad;
}

}  // namespace

float touch_likelihood(const Trajectory& trajectory, const satp::Mode& mode, const Track& track,
                       const Parameters& parameters) {
  OwnBoxes own(trajectory, parameters);
  int looks = 0;
  return touch_likelihood(own, mode, track, parameters, looks);
}

float expected_collisions(const scene::Scene& scene, const satp::PredictionSet& prediction,
                          const Trajectory& trajectory, const Parameters& parameters, WorkMeter& work) {
  OwnBoxes own(trajectory, parameters);
  float expected = 0.0F;
  int looks = 0;
  for (const satp::AgentPrediction& predicted : prediction.agents) {
    const Track& track = scene.agents[predicted.agent].track;
    if (!prediction.conditioned && follows_us(trajectory, track, parameters)) continue;
    for (const satp::Mode& mode : predicted.modes) {
      expected = expected + mode.probability * touch_likelihood(own, mode, track, parameters, looks);
    }
  }
  work.spend(kLookWork * looks);
  return expected;
}

}  // namespace s4tp::sadrf
