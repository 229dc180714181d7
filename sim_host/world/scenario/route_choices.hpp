#pragma once
/// The routes of a SUMO route file that its vehicles choose from: named ones, distributions of them, and those that are
/// sought from edge to edge. \throws std::runtime_error "ELEMENT: what was expected", all of them

#include <map>
#include <pugixml.hpp>
#include <string>
#include <vector>

#include "sim_host/world/map/network.hpp"

namespace s4tp::scenario {

class RouteChoices {
 public:
  /// One route or, of a distribution, several, each once, with their weights.
  using Choice = std::map<std::size_t, double>;  ///< by index for edges()

  explicit RouteChoices(const map::Network& network) : network_(network) {}

  /// Takes every <route> and <routeDistribution> among the children of `root`.
  void read(const pugi::xml_node& root);
  /// \param node  a <vehicle>, <trip> or <flow>
  [[nodiscard]] Choice of(const pugi::xml_node& node);
  /// As they stand in the file.
  [[nodiscard]] const std::vector<std::string>& edges(std::size_t route) const { return ways_[route]; }
  /// Towards kChoicesMax: routes are counted here, drivers by who reads them.
  void count(const pugi::xml_node& node, std::size_t more);

 private:
  std::size_t way(const std::vector<std::string>& edges);
  void add(const pugi::xml_node& node, std::size_t way, double weight, Choice& to);
  void append(const pugi::xml_node& node, const std::string& name, double weight, Choice& to);
  Choice distribution(const pugi::xml_node& node);

  const map::Network& network_;
  std::vector<std::vector<std::string>> ways_;
  std::map<std::vector<std::string>, std::size_t> way_index_;
  std::map<std::string, Choice> named_;
  std::size_t count_ = 0;  ///< of all that was built
};

}  // namespace s4tp::scenario
