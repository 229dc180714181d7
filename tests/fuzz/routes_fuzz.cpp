// A SUMO route file on a T-junction: refused with a reason, or traffic that can be drawn.

#include <cmath>

#include "sim_host/world/scenario/route_file.hpp"
#include "sim_host/world/traffic/random.hpp"
#include "sim_host/world/traffic/traffic_flow.hpp"
#include "tests/fuzz/files.hpp"

using namespace s4tp;
using namespace s4tp::scenario;
using fuzz::expect;

namespace {

void check(const Demand& demand, const map::Network& network) {
  for (const DemandFlow& flow : demand.flows) {
    expect(!flow.routes.empty() && flow.routes.size() == flow.route_weights.size(),
           "a flow has routes with weights");
    for (const std::size_t route : flow.routes)
      expect(route < demand.routes.size(), "a flow's route is one of the file's");
    expect(!flow.drivers.empty(), "somebody drives");
    for (const DriverModel& driver : flow.drivers) {
      expect(driver.length_m > 0.0 && driver.width_m > 0.0 && driver.min_gap_mean_m >= 0.0 &&
                 driver.weight >= 0.0 && driver.acceleration_mps2 > 0.0 && driver.deceleration_mps2 > 0.0 &&
                 driver.max_speed_mps > 0.0 && driver.headway_s > 0.0 && driver.sigma >= 0.0,
             "in a car and in a way there can be");
    }
    expect(std::isfinite(flow.begin_s) && flow.number >= 0, "a flow has a begin and a number");
  }
  for (const TrafficRoute& route : demand.routes) {
    expect(!route.edges.empty(), "a route has edges");
    for (const std::string& edge : route.edges)
      expect(!network.lanes_of(edge).empty(), "that are the network's");
    expect(route.end_lane < 0 || network.lane_of(route.edges.back(), route.end_lane) != map::kNoLane,
           "and ends on a lane");
  }
}

/// A minute of it, as an episode would draw it.
void draw(const Demand& demand, const map::Network& network) {
  traffic::Random random(1);
  const traffic::FlowPlan plan = traffic::draw_demand(network, demand, 60.0, random);
  double before_s = 0.0;
  for (const traffic::Departure& car : plan.departures) {
    expect(car.time_s >= before_s, "cars depart by time");
    before_s = car.time_s;
    expect(car.way < plan.ways.size() && car.lane >= 0 &&
               car.lane < static_cast<map::LaneId>(network.lanes.size()),
           "on a way and a lane");
    expect(std::isfinite(car.s_m) && !std::isnan(car.speed_mps) && car.length_m > 0.0 && car.width_m > 0.0,
           "as a car");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const map::Network network = map::load_network(S4TP_SOURCE_DIR "/tests/networks/tee.net.xml");
  const auto file =
      fuzz::folder().write("fuzz.rou.xml", std::string(reinterpret_cast<const char*>(data), size));
  static_cast<void>(fuzz::accepts("fuzz.rou.xml", [&] {
    const Demand demand = load_demand(file, network);
    check(demand, network);
    draw(demand, network);
  }));
  return 0;
}
