/// Reads SUMO's network format: https://sumo.dlr.de/docs/Networks/SUMO_Road_Networks.html

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <pugixml.hpp>
#include <set>
#include <stdexcept>

#include "sim_host/world/map/junction_links.hpp"
#include "sim_host/world/map/sumo_junction.hpp"
#include "sim_host/world/map/sumo_lane.hpp"
#include "sim_host/world/map/xml_values.hpp"

namespace s4tp::map {
namespace {

// NET-004. Shapes are followed step by step, so a number in a small file must not say how many steps that are.
constexpr double kLanesTogether_m = 2e7;    // of the whole network: those of a capital are 1.5e7
constexpr std::size_t kSuccessorsMax = 64;  // of one lane
constexpr double kPointsPerMetre = 10.0;    // of one lane, and ...
constexpr double kPointsBeside = 100.0;  // ... of the shortest: thinning them out is quadratic in a stretch

class Reader {
 public:
  Network read(const pugi::xml_node& net) {
    if (net.attribute("lefthand").as_bool()) {
      fail_at("<net lefthand>", "expected traffic on the right");
    }
    for (const pugi::xml_node edge : net.children("edge")) {
      read_edge(edge);
    }
    if (network_.lanes.empty()) {
      fail_at("<net>", "expected at least one <lane> that passenger cars may use");
    }
    for (const pugi::xml_node connection : net.children("connection")) {
      read_connection(connection);
    }
    bridge_junctions(net);
    for (const auto& [lane, connections] : connections_) {
      for (const Connection& connection : connections) {
        if (connection.open) {
          link_lanes(lane, first_usable(connection));
        }
      }
    }
    check_lengths();
    for (Lane& each : network_.lanes) {
      const bool whole = each.in_junction && each.predecessors.size() == 1 && each.successors.size() == 1;
      if (whole && !lane(each.predecessors[0]).in_junction && !lane(each.successors[0]).in_junction) {
        round_turn(each, lane(each.predecessors[0]), lane(each.successors[0]));
      }
    }
    network_.conflicts = find_conflicts(network_.lanes, read_junctions(net, network_.lanes, names_));
    join_seams();
    return std::move(network_);
  }

 private:
  /// A <connection>: lane names, `via` empty where it goes straight on to `to`.
  struct Connection {
    std::string via;
    std::string to;
    bool open = true;  ///< to cars
  };

  void read_edge(const pugi::xml_node& edge) {
    const std::string id = edge.attribute("id").value();
    const std::string function = edge.attribute("function").as_string("normal");
    if (id.empty()) {
      fail_at("<edge> at byte " + std::to_string(edge.offset_debug()), "expected an id");
    }
    const bool walked = function == "walkingarea" || function == "crossing";
    if (!names_.priority.try_emplace(id, edge.attribute("priority").as_int(-1)).second) {
      fail_at("edge \"" + id + "\"", "expected an id of its own; there is another of that name");
    }
    std::map<int, LaneId> by_index;
    std::map<int, bool> may_go_left;
    std::map<int, bool> may_go_right;
    for (const pugi::xml_node node : edge.children("lane")) {
      const std::string name = node.attribute("id").value();
      const std::string where = "lane \"" + name + "\" of edge \"" + id + "\"";
      const double index = lane_number(node, "index", -1.0, where);
      if (name.empty() || index < 0.0 || index > 99.0 || index != std::floor(index)) {
        fail_at(where, "expected an id and an index from 0 on");
      }
      if (!known_.insert(name).second || by_index.count(static_cast<int>(index)) != 0) {
        fail_at(where, "expected an id and an index of its own; there is another lane with it");
      }
      if (walked || !open_to_cars(node)) {
        continue;
      }
      std::optional<Lane> lane = read_lane(node, id, function == "internal", where);
      if (!lane) {
        continue;  // no longer than a point, as at a node that only ends one edge: passed over
      }
      lane->index = static_cast<int>(index);
      const LaneId number = static_cast<LaneId>(network_.lanes.size());
      by_index[lane->index] = number;
      may_go_left[lane->index] = change_open(node, "changeLeft");
      may_go_right[lane->index] = change_open(node, "changeRight");
      names_.lane_of[name] = number;
      network_.lanes.push_back(*std::move(lane));
    }
    for (const auto& [index, number] : by_index) {
      const auto left = by_index.find(index + 1);
      if (left == by_index.end() || network_.lanes[static_cast<std::size_t>(number)].in_junction) {
        continue;
      }
      if (may_go_left[index]) {
        network_.lanes[static_cast<std::size_t>(number)].left = left->second;
      }
      if (may_go_right[index + 1]) {
        network_.lanes[static_cast<std::size_t>(left->second)].right = number;
      }
    }
  }

  void read_connection(const pugi::xml_node& node) {
    const std::string from = node.attribute("from").value();
    const std::string to = node.attribute("to").value();
    const std::string where = "connection from \"" + from + "\" to \"" + to + "\"";
    for (const char* name : {"from", "to", "fromLane", "toLane"}) {
      if (!node.attribute(name)) {
        fail_at(where, std::string("expected the attribute ") + name);
      }
    }
    const std::string from_lane = from + "_" + node.attribute("fromLane").value();
    const std::string to_lane = to + "_" + node.attribute("toLane").value();
    const std::string via = node.attribute("via").value();
    for (const std::string& name : {from_lane, to_lane, via}) {
      if (!name.empty() && known_.count(name) == 0) {
        fail_at(where, "names the lane \"" + name + "\", which no <edge> has");
      }
    }
    const bool open =
        names_.lane_of.count(from_lane) != 0 && names_.lane_of.count(to_lane) != 0 && open_to_cars(node);
    if (open || from_lane.front() != ':') {
      connections_[from_lane].push_back({via, to_lane, open});
    } else {
      passed_over_[from_lane] = {via, to_lane};
    }
  }

  /// Built without lanes inside junctions: they are put in, in the order in which requests count the connections.
  void bridge_junctions(const pugi::xml_node& net) {
    for (const pugi::xml_node node : net.children("junction")) {
      const std::string id = node.attribute("id").value();
      int number = 0;
      for (const std::string& from : words_in(node.attribute("incLanes").value())) {
        const auto connections = connections_.find(from);
        for (std::size_t i = 0; connections != connections_.end() && i < connections->second.size(); ++i) {
          Connection& connection = connections->second[i];
          const std::string name = ":" + id + "_" + std::to_string(number++);
          if (!connection.via.empty() || from.front() == ':') {
            continue;
          }
          std::string inside;
          if (connection.open) {
            const LaneId before = names_.lane_of.at(from);
            const LaneId after = names_.lane_of.at(connection.to);
            if (std::optional<Lane> bridge = bridge_between(lane(before), lane(after))) {
              inside = name + "_0";
              bridge->name = inside;
              bridge->edge = name;
              if (!known_.insert(inside).second) {
                fail_at("junction \"" + id + "\"", "expected a via for each of its connections, or for none");
              }
              names_.lane_of[inside] = static_cast<LaneId>(network_.lanes.size());
              network_.lanes.push_back(*std::move(bridge));
              connections_[inside].push_back({"", connection.to, true});
              connection.via = inside;
            }
          }
          names_.bridges[id].push_back(inside);
        }
      }
    }
  }

  /// Where a way leads first: its junction lane, or what comes after it if that was passed over.
  std::string first_usable(const Connection& connection) const {
    Connection at = connection;
    for (std::size_t hops = 0; !at.via.empty() && hops <= known_.size(); ++hops) {
      if (names_.lane_of.count(at.via) != 0) {
        return at.via;
      }
      const auto next = passed_over_.find(at.via);
      if (next == passed_over_.end()) {
        break;
      }
      at = next->second;
    }
    return at.to;
  }

  void check_lengths() const {
    double together_m = 0.0;
    for (const Lane& each : network_.lanes) {
      together_m += each.centre.length_m();
      check_density(each);
      if (each.in_junction) check_through(each, each.centre.length_m());
    }
    if (together_m > kLanesTogether_m) {
      fail_at("<net>", "its lanes are " + std::to_string(std::lround(0.001 * together_m)) +
                           " km long together: expected at most 20000 km");
    }
  }

  static void check_density(const Lane& lane) {
    const double most = kPointsBeside + kPointsPerMetre * lane.centre.length_m();
    if (static_cast<double>(lane.centre.points().size()) > most) {
      fail_at("lane \"" + lane.name + "\"", "its shape has " + std::to_string(lane.centre.points().size()) +
                                                " points: expected at most 10 a metre, and 100");
    }
  }

  void link_lanes(const std::string& from, const std::string& to) {
    const auto target = names_.lane_of.find(to);
    if (target == names_.lane_of.end()) {
      return;
    }
    const LaneId from_id = names_.lane_of.at(from);
    std::vector<LaneId>& successors = network_.lanes[static_cast<std::size_t>(from_id)].successors;
    if (std::find(successors.begin(), successors.end(), target->second) == successors.end()) {
      successors.push_back(target->second);
      if (successors.size() > kSuccessorsMax) {
        fail_at("lane \"" + from + "\"", "it leads to more than 64 lanes");
      }
      network_.lanes[static_cast<std::size_t>(target->second)].predecessors.push_back(from_id);
    }
  }

  /// Where nobody crosses or merges (a node that only adds or ends a lane) a junction is a mere seam: its
  /// lanes are neighbours like those before and after it.
  void join_seams() {
    std::set<std::string> crossed;
    for (const Conflict& conflict : network_.conflicts) {
      crossed.insert(lane(conflict.first).edge);
      crossed.insert(lane(conflict.second).edge);
    }
    for (std::size_t i = 0; i + 1 < network_.lanes.size(); ++i) {  // lanes of an edge stand together
      Lane& right = network_.lanes[i];
      Lane& left = network_.lanes[i + 1];
      if (right.in_junction && right.edge == left.edge && left.index == right.index + 1 &&
          crossed.count(right.edge) == 0) {
        right.left = static_cast<LaneId>(i) + 1;
        left.right = static_cast<LaneId>(i);
      }
    }
  }

  const Lane& lane(LaneId id) const { return network_.lanes[static_cast<std::size_t>(id)]; }

  Network network_;
  NetworkNames names_;
  std::set<std::string> known_;  ///< every lane's name, those cars may not use too
  std::map<std::string, std::vector<Connection>> connections_;
  std::map<std::string, Connection> passed_over_;
};

}  // namespace

Network load_network(const std::filesystem::path& file) {
  const pugi::xml_document document = parse_xml(file.string());
  try {
    if (!document.child("net")) {
      fail_at("the root element", "expected <net>, as netconvert writes it");
    }
    return Reader().read(document.child("net"));
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(file.string() + ": " + error.what());
  }
}

}  // namespace s4tp::map
