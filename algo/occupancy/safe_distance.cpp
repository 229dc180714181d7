#include "algo/occupancy/safe_distance.hpp"

#include "algo/core/inline.hpp"
#include "algo/occupancy/pace.hpp"

namespace s4tp::occupancy {

float safe_distance_m(float rear_speed_mps, float front_speed_mps, const Parameters& parameters) {
  const auto& rss = parameters.rss;
  const float later_mps = rear_speed_mps + rss.response_s * rss.acceleration_mps2;
  const float response_m =
      rear_speed_mps * rss.response_s + 0.5F * rss.acceleration_mps2 * square(rss.response_s);
  const float rear_m = response_m + stopping_way_m(later_mps, rss.braking_min_mps2);
  return max(0.0F, rear_m - stopping_way_m(front_speed_mps, rss.braking_max_mps2));
}

}  // namespace s4tp::occupancy
