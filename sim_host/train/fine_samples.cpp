#include "sim_host/train/fine_samples.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "algo/core/math.hpp"
#include "algo/satp/network_shape.hpp"

namespace s4tp::train {
namespace {

using satp::PairFeature;

static_assert(kFineLanePoints == satp::kFullShape.lane_points &&
                  kHorizonSteps == satp::kFullShape.decoder_steps,
              "the grid of full");
static_assert((satp::kLanePoints - 1) * kLaneFineness < kFineLanePoints, "a sample's lane path fits");

constexpr int kHeading = 2;  // column of a pose

float between(float from, float to, float share) {
  return from + share * (to - from);
}

// x, y on a straight line, the heading along the shorter arc.
void pose_between(const float* from, const float* to, float share, float* pose) {
  pose[0] = between(from[0], to[0], share);
  pose[1] = between(from[1], to[1], share);
  const float turn = to[kHeading] - from[kHeading];
  pose[kHeading] = wrap_angle(from[kHeading] + share * wrap_angle(turn));
}

}  // namespace

FineLane fine_lane(const float (&row)[satp::kLanePoints][satp::kLaneFeatures], int points) {
  FineLane fine;
  fine.points = (points - 1) * kLaneFineness + 1;
  for (int p = 0; p < fine.points; ++p) {
    const int first = p / kLaneFineness;
    const float share = static_cast<float>(p % kLaneFineness) / static_cast<float>(kLaneFineness);
    std::copy(std::begin(row[first]), std::end(row[first]), fine.row[p]);
    if (p % kLaneFineness != 0) pose_between(row[first], row[first + 1], share, fine.row[p]);
  }
  return fine;
}

FinePlan fine_plan(const float (&step)[satp::kDecoderSteps][satp::kPlanValues],
                   const float (&pair)[satp::kPairFeatures]) {
  constexpr int kEnd = 3;    // columns from here on tell of a step's end: pose,
  constexpr int kSpeed = 6;  // speed, way left to the zone's entry and exit
  const bool zone = pair[static_cast<int>(PairFeature::kZone)] > 0.0F;
  const float at_begin[] = {pair[static_cast<int>(PairFeature::kOurSpeedMps)],
                            zone ? pair[static_cast<int>(PairFeature::kOurEntryM)] : 0.0F,
                            zone ? pair[static_cast<int>(PairFeature::kOurExitM)] : 0.0F};
  FinePlan fine;
  for (int s = 0; s < kHorizonSteps; ++s) {
    const int of = s / satp::kStepsPerDecode;
    const auto share = [&](int steps) {
      return static_cast<float>(s % satp::kStepsPerDecode + steps) /
             static_cast<float>(satp::kStepsPerDecode);
    };
    float(&row)[satp::kPlanValues] = fine.step[s];
    pose_between(step[of], step[of] + kEnd, share(0), row);
    pose_between(step[of], step[of] + kEnd, share(1), row + kEnd);
    const float* const before = of == 0 ? at_begin : step[of - 1] + kSpeed;
    for (int i = 0; i < satp::kPlanValues - kSpeed; ++i)
      row[kSpeed + i] = between(before[i], step[of][kSpeed + i], share(1));
  }
  return fine;
}

EgoMotion ego_motion(const Sample& sample) {
  EgoMotion motion;
  motion.known = sample.input.hdvs > 0 && (sample.flags & kNoPlan) == 0;
  if (!motion.known) return motion;
  const float(&place)[satp::kPlaceFeatures] = sample.input.place[1];
  const float sin = place[2];
  const float cos = place[3];
  for (int s = 0; s < satp::kDecoderSteps; ++s) {
    const float* const end = sample.plan.step[0][s] + 3;
    motion.pose[s][0] = place[0] + cos * end[0] - sin * end[1];
    motion.pose[s][1] = place[1] + sin * end[0] + cos * end[1];
    motion.pose[s][kHeading] = wrap_angle(end[kHeading] + std::atan2(sin, cos));
  }
  return motion;
}

}  // namespace s4tp::train
