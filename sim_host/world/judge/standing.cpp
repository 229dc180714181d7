#include "sim_host/world/judge/standing.hpp"

#include <algorithm>

namespace s4tp::judge {
namespace {

constexpr double kUsualLength_m = 5.0;  // map::Conflict's boxes
constexpr double kPlace_m = 0.5;        // between two zones: so much room and a car may stand there

}  // namespace

double longer_by_m(double length_m) {
  return 0.5 * (length_m - kUsualLength_m);
}

std::vector<ZoneGroup> zone_groups(const traffic::RoadIndex& road, std::span<const Stretch> way,
                                   double length_m) {
  const double grown_m = longer_by_m(length_m);
  std::vector<ZoneOnWay> zones;
  for (const Stretch& stretch : way) {
    for (const traffic::Meeting& meeting : road.meetings(stretch.lane)) {
      const ZoneOnWay zone{stretch.lane, meeting, stretch.start_m + meeting.entry_m - grown_m,
                           stretch.start_m + meeting.exit_m + grown_m};
      if (zone.exit_m > stretch.from_m && zone.entry_m <= stretch.until_m) {
        zones.push_back(zone);
      }
    }
  }
  std::sort(zones.begin(), zones.end(),
            [](const ZoneOnWay& a, const ZoneOnWay& b) { return a.entry_m < b.entry_m; });
  std::vector<ZoneGroup> groups;
  for (const ZoneOnWay& zone : zones) {
    if (groups.empty() || zone.entry_m > groups.back().exit_m + kPlace_m) {
      groups.push_back({zone.entry_m, zone.exit_m, {}});
    }
    groups.back().exit_m = std::max(groups.back().exit_m, zone.exit_m);
    groups.back().zones.push_back(zone);
  }
  return groups;
}

bool may_stand(std::span<const ZoneGroup> groups, double at_m) {
  return std::none_of(groups.begin(), groups.end(),
                      [&](const ZoneGroup& group) { return at_m > group.entry_m && at_m < group.exit_m; });
}

}  // namespace s4tp::judge
