// A SUMO network: refused with a reason, or lanes, links and conflicts that hold together and can be driven along; what a
// drive makes of it takes no more memory than reading it.

#include <cmath>

#include "sim_host/world/map/network.hpp"
#include "sim_host/world/nodes/map_node.hpp"
#include "sim_host/world/traffic/locator.hpp"
#include "sim_host/world/traffic/traffic_view.hpp"
#include "tests/fuzz/files.hpp"

using namespace s4tp;
using namespace s4tp::map;
using fuzz::expect;

namespace {

void check(const Network& network) {
  const auto count = static_cast<LaneId>(network.lanes.size());
  const auto there = [count](LaneId lane) { return lane >= 0 && lane < count; };
  for (LaneId id = 0; id < count; ++id) {
    const Lane& lane = network.lanes[static_cast<std::size_t>(id)];
    expect(lane.centre.points().size() >= 2 && std::isfinite(lane.centre.length_m()) &&
               lane.centre.length_m() > 0.0,
           "a lane is a line of some length");
    expect(lane.width_m > 0.0 && lane.speed_limit_mps >= 0.0 && std::isfinite(lane.speed_limit_mps),
           "a lane has a width and a limit");
    for (const Vec2 point : lane.centre.points())
      expect(std::isfinite(point.x) && std::isfinite(point.y), "finite points");
    for (const LaneId next : lane.successors) expect(there(next), "a successor is a lane");
    for (const LaneId before : lane.predecessors) expect(there(before), "a predecessor is a lane");
    expect(lane.left == kNoLane || there(lane.left), "a neighbour is a lane");
    expect(lane.right == kNoLane || there(lane.right), "a neighbour is a lane");
    expect(network.find(lane.name) != kNoLane, "a lane is found by its name");
    expect(network.lane_of(lane.edge, lane.index) != kNoLane, "and by its number");
    const PolylineProjection back = lane.centre.project(lane.centre.at(0.5 * lane.centre.length_m()).point);
    expect(std::isfinite(back.s_m) && std::isfinite(back.d_m), "a lane can be projected onto");
  }
  for (const Conflict& conflict : network.conflicts) {
    expect(there(conflict.first) && there(conflict.second) && conflict.first != conflict.second,
           "two lanes conflict");
    expect(
        conflict.first_entry_m <= conflict.first_exit_m && conflict.second_entry_m <= conflict.second_exit_m,
        "a conflict is entered before it is left");
  }
}

void drive(const Network& network) {
  const RouteGuide guide(network, {network.lanes.front().edge}, kNoLane, 0.0);
  const Vec2 start = network.lanes.front().centre.points().front();
  const traffic::Locator locator(network, guide);
  const traffic::RoadIndex road(network);
  expect(!locator.off_road(start), "a lane's start is on the road");
  nodes::MapNode map(network, guide, start, 150.0);
  for (const wire::Lane& lane : map.update(start).lanes)
    expect(!lane.present || (lane.point_count >= 2 && lane.point_count <= wire::kMaxLanePoints),
           "parts can be sent");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file =
      fuzz::folder().write("fuzz.net.xml", std::string(reinterpret_cast<const char*>(data), size));
  static_cast<void>(fuzz::accepts("fuzz.net.xml", [&] {
    const Network network = load_network(file);
    check(network);
    drive(network);
  }));
  return 0;
}
