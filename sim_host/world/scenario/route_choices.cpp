#include "sim_host/world/scenario/route_choices.hpp"

#include <stdexcept>

#include "sim_host/world/map/find_route.hpp"
#include "sim_host/world/map/xml_values.hpp"
#include "sim_host/world/scenario/flow_attributes.hpp"
#include "sim_host/world/scenario/traffic_limits.hpp"
#include "sim_host/world/scenario/vehicle_types.hpp"

namespace s4tp::scenario {
namespace {

std::vector<std::string> edges_of(const pugi::xml_node& node) {
  const std::vector<std::string> edges = map::words_in(node.attribute("edges").value());
  if (edges.empty()) {
    fail_at(node, "edges: expected at least one edge");
  }
  return edges;
}

}  // namespace

void RouteChoices::read(const pugi::xml_node& root) {
  for (const pugi::xml_node node : root.children("route")) {
    named_[node.attribute("id").value()] = {{way(edges_of(node)), 1.0}};
  }
  for (const pugi::xml_node node : root.children("routeDistribution")) {
    named_[node.attribute("id").value()] = distribution(node);
  }
}

RouteChoices::Choice RouteChoices::of(const pugi::xml_node& node) {
  if (const pugi::xml_node own = node.child("route")) {
    return {{way(edges_of(own)), 1.0}};
  }
  if (const pugi::xml_node own = node.child("routeDistribution")) {
    return distribution(own);
  }
  Choice choice;
  if (node.attribute("route")) {
    append(node, node.attribute("route").value(), 1.0, choice);
    return choice;
  }
  std::vector<std::string> stations = map::words_in(node.attribute("via").value());
  for (const char* end : {"from", "to"}) {
    if (!node.attribute(end)) {
      fail_at(node, "expected a route, or from and to edges (zones and junctions as ends are not known)");
    }
  }
  stations.insert(stations.begin(), node.attribute("from").value());
  stations.push_back(node.attribute("to").value());
  std::vector<std::string> edges{stations.front()};
  // Longer than the network is, it passes an edge again, from where it is left out anyway.
  for (std::size_t i = 1; i < stations.size() && edges.size() <= network_.lanes.size(); ++i) {
    try {
      const std::vector<std::string> on = map::find_route(network_, stations[i - 1], stations[i]);
      edges.insert(edges.end(), on.begin() + 1, on.end());
    } catch (const std::runtime_error& error) {
      fail_at(node, error.what());
    }
  }
  return {{way(edges), 1.0}};
}

void RouteChoices::count(const pugi::xml_node& node, std::size_t more) {
  count_ += more;
  if (count_ > kChoicesMax) {
    fail_at(node,
            "the file has more than " + std::to_string(kChoicesMax) + " routes and drivers to choose from");
  }
}

/// Equal ones have one index.
std::size_t RouteChoices::way(const std::vector<std::string>& edges) {
  const auto [entry, is_new] = way_index_.try_emplace(edges, ways_.size());
  if (is_new) {
    ways_.push_back(edges);
  }
  return entry->second;
}

/// Distributions of distributions grow fast; weights grow with them.
void RouteChoices::add(const pugi::xml_node& node, std::size_t way, double weight, Choice& to) {
  const auto [entry, is_new] = to.try_emplace(way, 0.0);
  entry->second += weight;
  count(node, is_new ? 1 : 0);
  if (to.size() > kChoiceMax) {
    fail_at(node, "more than " + std::to_string(kChoiceMax) + " routes to choose from");
  }
  if (entry->second > kWeightMax) {
    fail_at(node, "a route of more than " + std::to_string(static_cast<long>(kWeightMax)) +
                      " times the weight of another");
  }
}

void RouteChoices::append(const pugi::xml_node& node, const std::string& name, double weight, Choice& to) {
  const auto found = named_.find(name);
  if (found == named_.end()) {
    fail_at(node, "there is no <route id=\"" + name + "\">");
  }
  for (const auto& [way, own] : found->second) {
    add(node, way, weight * own, to);
  }
}

RouteChoices::Choice RouteChoices::distribution(const pugi::xml_node& node) {
  Choice choice;
  for (const pugi::xml_node route : node.children("route")) {
    if (const pugi::xml_attribute refers = route.attribute("refId")) {
      append(node, refers.value(), attribute_number(route, "probability", 1.0, 0.0, 1e9), choice);
      continue;
    }
    const std::size_t own = way(edges_of(route));
    add(node, own, attribute_number(route, "probability", 1.0, 0.0, 1e9), choice);
    if (route.attribute("id")) {
      named_[route.attribute("id").value()] = {{own, 1.0}};
    }
  }
  const std::vector<std::string> names = map::words_in(node.attribute("routes").value());
  const std::vector<std::string> weights = map::words_in(node.attribute("probabilities").value());
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double weight = weights.empty()      ? 1.0
                          : i < weights.size() ? map::number_in(weights[i]).value_or(-1.0)
                                               : -1.0;
    if (weight < 0.0) {
      fail_at(node, "probabilities: expected a number of 0 and more for each of routes");
    }
    append(node, names[i], weight, choice);
  }
  if (choice.empty()) {
    fail_at(node, "expected at least one route");
  }
  return choice;
}

}  // namespace s4tp::scenario
