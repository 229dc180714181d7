#include "sim_host/world/scenario/route_file.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include "sim_host/world/map/xml_values.hpp"
#include "sim_host/world/scenario/flow_attributes.hpp"
#include "sim_host/world/scenario/route_choices.hpp"
#include "sim_host/world/scenario/traffic_limits.hpp"
#include "sim_host/world/scenario/vehicle_types.hpp"

namespace s4tp::scenario {
namespace {

/// Draws made for a flow before the episode begins.
double draws_of(const DemandFlow& flow) {
  const double span_s = std::max(std::min(flow.end_s, kCarsCounted_s) - flow.begin_s, 0.0);
  const double period_s = flow.spacing == DemandFlow::Spacing::kPerSecond ? 1.0 : flow.period_s;
  return flow.spacing == DemandFlow::Spacing::kPerSecond
             ? span_s
             : std::min(span_s / period_s + 1.0, static_cast<double>(flow.number));
}

class Reader {
 public:
  explicit Reader(const map::Network& network) : network_(network), choices_(network) {}

  Demand read(const pugi::xml_node& root) {
    types_.read(root);
    choices_.read(root);
    read_demand(root, pugi::xml_node());
    for (const auto& [what, count] : left_out_) {
      demand_.notes.push_back(std::to_string(count) + " left out: " + what);
    }
    return std::move(demand_);
  }

 private:
  /// \param interval  gives begin and end to the flows in it; may be empty
  void read_demand(const pugi::xml_node& parent, const pugi::xml_node& interval) {
    static const std::set<std::string> elsewhere{"person", "personFlow", "container", "containerFlow"};
    static const std::set<std::string> known{"route", "routeDistribution", "vType", "vTypeDistribution",
                                             "param"};
    for (const pugi::xml_node node : parent.children()) {
      const std::string name = node.name();
      if (node.type() != pugi::node_element || known.count(name) != 0) {
        continue;
      }
      if (name == "vehicle" || name == "trip" || name == "flow") {
        read_flow(node, interval);
      } else if (name == "interval" && !interval) {
        read_demand(node, node);
      } else if (elsewhere.count(name) != 0) {
        leave_out("<" + name + ">: only vehicles on the road are simulated");
      } else {
        fail_at(
            node,
            "expected vehicle, trip, flow, route, routeDistribution, vType, vTypeDistribution or interval");
      }
    }
  }

  void leave_out(const std::string& what) { ++left_out_[what]; }

  void read_flow(const pugi::xml_node& node, const pugi::xml_node& interval) {
    DemandFlow flow;
    flow.id = node.attribute("id").value();
    const std::string depart = node.attribute("depart").value();
    if (depart == "triggered" || depart == "containerTriggered" || depart == "split") {
      leave_out("<" + std::string(node.name()) + "> with depart=\"" + depart + "\": nobody gets in");
      return;
    }
    const std::string type = node.attribute("type").as_string("DEFAULT_VEHTYPE");
    const std::vector<VehicleType>* kinds = types_.find(type);
    if (kinds == nullptr) {
      fail_at(node, "there is no <vType id=\"" + type + "\">");
    }
    if (kinds->size() > kDriversMax) {
      fail_at(node, "more than " + std::to_string(kDriversMax) + " kinds of drivers to choose from");
    }
    choices_.count(node, kinds->size());
    bool car = false;
    for (const VehicleType& kind : *kinds) {
      if (kind.use != RoadUse::kElsewhere) {
        flow.drivers.push_back(kind.model);
        read_speed_factor(node, flow.drivers.back());
        car = car || kind.use == RoadUse::kCar;
      }
    }
    if (flow.drivers.empty()) {
      leave_out("<" + std::string(node.name()) + "> of type \"" + type + "\": not on the road");
      return;
    }
    if (node.child("stop")) {
      leave_out("<stop> of a " + std::string(node.name()) + ": drivers do not stop on their way");
    }
    if (std::string(node.name()) == "flow") {
      read_spacing(node, interval, flow);
    } else {
      if (depart.empty()) {
        fail_at(node, "depart: missing");
      }
      flow.begin_s = time_of(node, "depart", 0.0);
      flow.number = 1;
    }
    read_depart(node, flow.depart);
    try {
      add_routes(node, flow);
    } catch (const std::runtime_error& error) {
      if (car) {
        throw;
      }
      leave_out("<" + std::string(node.name()) + "> of type \"" + type + "\" on a way closed to cars");
      return;
    }
    cars_ += draws_of(flow);
    if (cars_ > kCarsMax) {
      fail_at(node, "more than " + std::to_string(static_cast<int>(kCarsMax)) + " cars, with those before");
    }
    demand_.flows.push_back(std::move(flow));
  }

  void add_routes(const pugi::xml_node& node, DemandFlow& flow) {
    const std::string arrival = node.attribute("arrivalLane").as_string("current");
    for (const auto& [chosen, weight] : choices_.of(node)) {
      std::vector<std::string> edges = choices_.edges(chosen);
      std::set<std::string> seen;
      const auto again = std::find_if(edges.begin(), edges.end(),
                                      [&](const std::string& e) { return !seen.insert(e).second; });
      if (again != edges.end()) {
        leave_out("the rest of a way from where it passes an edge again");
        edges.erase(again, edges.end());
      }
      TrafficRoute route{edges, -1, -1};
      if (const std::optional<double> lane = map::number_in(arrival);
          lane &&
          network_.lane_of(edges.back(), static_cast<int>(std::clamp(*lane, -1.0, 99.0))) != map::kNoLane) {
        route.end_lane = static_cast<int>(*lane);
      }
      if (flow.depart.lane == DepartWish::Lane::kNumber &&
          network_.lane_of(edges.front(), flow.depart.lane_number) == map::kNoLane) {
        fail_at(node,
                quoted(node, "departLane") + ": edge \"" + edges.front() + "\" has no such lane for cars");
      }
      flow.routes.push_back(index_of(node, route));
      flow.route_weights.push_back(weight);
    }
  }

  /// Each way is kept once: there may be thousands of cars on it.
  std::size_t index_of(const pugi::xml_node& node, const TrafficRoute& route) {
    const auto [entry, is_new] = index_.try_emplace({route.edges, route.end_lane}, demand_.routes.size());
    if (is_new) {
      try {
        guided_ += map::RouteGuide(network_, route.edges, map::kNoLane, 0.0).size();
      } catch (const std::runtime_error& error) {
        index_.erase(entry);
        fail_at(node, error.what());
      }
      if (guided_ > kGuidedMax) {
        fail_at(node,
                "the file's routes lead along more than " + std::to_string(kGuidedMax) + " lanes together");
      }
      demand_.routes.push_back(route);
      return demand_.routes.size() - 1;
    }
    return entry->second;
  }

  const map::Network& network_;
  VehicleTypes types_;
  RouteChoices choices_;
  std::size_t guided_ = 0;  ///< lanes along demand_.routes
  double cars_ = 0.0;
  std::map<std::pair<std::vector<std::string>, int>, std::size_t> index_;
  std::map<std::string, int> left_out_;
  Demand demand_;
};

}  // namespace

Demand load_demand(const std::filesystem::path& file, const map::Network& network) {
  const pugi::xml_document document = map::parse_xml(file.string());
  pugi::xml_node root = document.child("routes");
  root = root ? root : document.child("additional");
  if (!root) {
    throw std::runtime_error(file.string() + ": the root element: expected <routes>");
  }
  try {
    return Reader(network).read(root);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(file.string() + ": " + error.what());
  }
}

}  // namespace s4tp::scenario
