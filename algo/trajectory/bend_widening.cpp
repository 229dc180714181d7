#include "algo/trajectory/bend_widening.hpp"

#include "algo/core/inline.hpp"
#include "algo/trajectory/bicycle.hpp"
#include "algo/trajectory/elastic_band.hpp"

namespace s4tp::trajectory {
namespace {

constexpr int kMostMoves = 300;          // of samples, to widen bends: one of 25 samples twelve times
constexpr int kEdgeSamples = 4;          // at the ends, which widening leaves as they are
constexpr int kWidenedSamples = 8;       // each way around what is too tight
constexpr float kSteeringShare = 0.97F;  // some is left to follow with

// Work (WorkMeter's units).
constexpr int kMoveWork = 3;  // of one

/// The next stretch from `from` on that bends more than `limit_1pm` with what is around it. \return false: none
bool find_too_tight(const ReferenceLine& line, float limit_1pm, int from, int& first, int& end) {
  bool any = false;
  for (int i = from > kEdgeSamples ? from : kEdgeSamples; i + kEdgeSamples < kReferenceSamples; ++i) {
    const Point here = position(line.samples[i].pose);
    const Point in = here - position(line.samples[i - 1].pose);
    if (bend_1pm(in, position(line.samples[i + 1].pose) - here) <= limit_1pm) continue;
    if (any && i - kWidenedSamples > end) break;
    const int before = i - kWidenedSamples;
    const int after = i + kWidenedSamples + 1;
    if (!any) first = before > from ? before : from;
    any = true;
    end = after < kReferenceSamples - 2 ? after : kReferenceSamples - 2;
  }
  return any;
}

}  // namespace

int widen_tight_bends(const Parameters& parameters, ReferenceLine& line) {
  const float limit_1pm =
      kSteeringShare * curvature_for(parameters.vehicle.steering_max_rad, parameters.vehicle.wheelbase_m);
  int moves = kMostMoves;
  int first = 0;
  int end = 2;
  line.tight = false;
  while (moves > 0 && find_too_tight(line, limit_1pm, end, first, end)) {
    // Out before the corner, in at it, out behind it, as one drives a narrow corner.
    ElasticBand stretch(line, first, end);
    bool drivable = false;
    while (moves > 0 && !drivable) {
      stretch.solve();
      drivable = stretch.weigh_bends(limit_1pm) <= 1.0F;
      moves -= end - first;
    }
    stretch.apply();
    if (!line.tight) line.tight_from_s_m = line.start_s_m + static_cast<float>(first) * line.spacing_m;
    line.tight = true;
    line.tight_to_s_m = line.start_s_m + static_cast<float>(end) * line.spacing_m;
  }
  return kMoveWork * (kMostMoves - moves);
}

}  // namespace s4tp::trajectory
