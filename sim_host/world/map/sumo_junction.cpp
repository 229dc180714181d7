#include "sim_host/world/map/sumo_junction.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "sim_host/world/map/sumo_lane.hpp"
#include "sim_host/world/map/xml_values.hpp"

namespace s4tp::map {
namespace {

// NET-004. Shapes are followed step by step, so a number in a small file must not say how many steps that are.
constexpr double kLongestThroughJunction_m = 1'000.0;  // of one way
constexpr double kWaysThroughJunction_m = 8'000.0;  // of all ways of one junction: each is compared with each
constexpr std::size_t kLinksMax = 256;              // of one junction: as many as SUMO builds
constexpr std::size_t kPartsOfWay = 100;            // lanes in a row, inside a junction

class JunctionReader {
 public:
  JunctionReader(const std::vector<Lane>& lanes, const NetworkNames& names) : lanes_(lanes), names_(names) {}

  /// The link that a lane inside a junction belongs to, and its index among the junction's requests: intLanes
  /// lists the lanes in their order, of a link in two parts the second one.
  std::vector<Junction> read(const pugi::xml_node& net) const {
    std::vector<Junction> junctions;
    std::set<LaneId> listed;
    for (const pugi::xml_node node : net.children("junction")) {
      if (std::string(node.attribute("type").value()) == "internal") {
        continue;
      }
      const std::string where = "junction \"" + std::string(node.attribute("id").value()) + "\"";
      Junction junction;
      double ways_m = 0.0;
      junction.signals = std::string(node.attribute("type").value()).rfind("traffic_light", 0) == 0;
      junction.first_come = std::string(node.attribute("type").value()) == "allway_stop";
      std::vector<std::string> names = words_in(node.attribute("intLanes").value());
      const auto bridges = names_.bridges.find(node.attribute("id").value());
      if (names.empty() && bridges != names_.bridges.end()) {
        names = bridges->second;
      }
      if (names.size() > kLinksMax) fail_at(where, "it has more than 256 ways through it");
      for (const std::string& name : names) {
        const auto inside = names_.lane_of.find(name);
        if (inside != names_.lane_of.end() && !listed.insert(inside->second).second) {
          fail_at(where, "lists the lane \"" + name + "\", which is listed already");
        }
        junction.links.push_back(inside == names_.lane_of.end() ? Link{} : link_through(inside->second));
        for (const LaneId part : junction.links.back().inside) ways_m += lane(part).centre.length_m();
        if (ways_m > kWaysThroughJunction_m) {
          fail_at(where, "its ways are more than 8 km long together");
        }
      }
      if (junction.links.empty()) {
        continue;
      }
      for (const pugi::xml_node request : node.children("request")) {
        const std::size_t index = request.attribute("index").as_uint(~0U);
        const std::string response = request.attribute("response").value();
        if (index >= junction.links.size() || response.find_first_not_of("01") != std::string::npos) {
          fail_at(where, "request index=\"" + std::string(request.attribute("index").value()) +
                             "\": expected an index below the number of intLanes, and response of 0s and 1s");
        }
        std::vector<bool>& yields_to = junction.links[index].yields_to;
        yields_to.resize(response.size());  // the text's last character is link 0
        std::transform(response.rbegin(), response.rend(), yields_to.begin(),
                       [](char c) { return c == '1'; });
      }
      junctions.push_back(std::move(junction));
    }
    return junctions;
  }

 private:
  const Lane& lane(LaneId id) const { return lanes_[static_cast<std::size_t>(id)]; }

  Link link_through(LaneId inside) const {
    Link link;
    link.inside = {inside};
    while (!lane(link.inside.front()).predecessors.empty() &&
           lane(lane(link.inside.front()).predecessors.front()).in_junction &&
           link.inside.size() <= kPartsOfWay) {
      link.inside.insert(link.inside.begin(), lane(link.inside.front()).predecessors.front());
    }
    while (!lane(link.inside.back()).successors.empty() &&
           lane(lane(link.inside.back()).successors.front()).in_junction &&
           link.inside.size() <= kPartsOfWay) {
      link.inside.push_back(lane(link.inside.back()).successors.front());
    }
    if (lane(link.inside.front()).predecessors.empty() || lane(link.inside.back()).successors.empty()) {
      return {};  // no car can come here or get away
    }
    if (link.inside.size() > kPartsOfWay) {
      fail_at("lane \"" + lane(inside).name + "\"", "its way through the junction has more than 100 lanes");
    }
    link.from = lane(link.inside.front()).predecessors.front();
    link.to = lane(link.inside.back()).successors.front();
    link.priority = names_.priority.at(lane(link.from).edge);
    double length_m = 0.0;
    for (const LaneId each : link.inside) {
      length_m += lane(each).centre.length_m();
    }
    check_through(lane(inside), length_m);
    return link;
  }

  const std::vector<Lane>& lanes_;
  const NetworkNames& names_;
};

}  // namespace

std::vector<Junction> read_junctions(const pugi::xml_node& net, const std::vector<Lane>& lanes,
                                     const NetworkNames& names) {
  return JunctionReader(lanes, names).read(net);
}

void check_through(const Lane& inside, double length_m) {
  if (length_m > kLongestThroughJunction_m) {
    fail_at("lane \"" + inside.name + "\"", "its way through the junction is " +
                                                std::to_string(std::lround(length_m)) +
                                                " m long: expected at most 1000 m");
  }
}

}  // namespace s4tp::map
