#include "sim_host/roads/road.hpp"

namespace s4tp::roads {

const std::vector<Family>& families() {
  static const std::vector<Family> kFamilies{
      {"crossing_left", draw_crossing_left},
      {"crossing_straight", draw_crossing_straight},
      {"crossing_right", draw_crossing_right},
      {"tee_left", draw_tee_left},
      {"tee_right", draw_tee_right},
      {"late_change", draw_late_change},
      {"roundabout", draw_roundabout},
      {"ramp_junction", draw_ramp_junction},
      {"ramp_lane", draw_ramp_lane},
      {"lane_drop", draw_lane_drop},
      {"curve", draw_curve},
      {"cruise", draw_cruise},
      {"overtake", draw_overtake},
      {"cut_in", draw_cut_in},
  };
  return kFamilies;
}

}  // namespace s4tp::roads
