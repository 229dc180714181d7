#include "sim_host/world/nodes/world_nodes.hpp"

#include <cmath>

#include "firmware/wire/codec.hpp"
#include "firmware/wire/version.hpp"
#include "sim_host/world/nodes/append_frame.hpp"

namespace s4tp::nodes {
namespace {

constexpr int kMapFramesPerTick = 3;
constexpr int kMapFramesPerTickAtStart = 7;
constexpr std::uint32_t kMapUpdate_ms = 200;
constexpr std::uint32_t kPerceptionPhase_ms = 70;  // a list is complete before the next 100 ms boundary
constexpr std::uint32_t kSlow_ms = 1000;

/// MapOrigin reaches 838 km: of coordinates counted from further away (UTM's) it says the last 1000 km.
double on_the_wire(double coordinate_m) {
  return std::remainder(coordinate_m, 1e6);
}

}  // namespace

WorldNodes::WorldNodes(const map::Network& network, const map::RouteGuide& guide, map::Vec2 origin,
                       const scenario::PerceptionOptions& perception, std::uint64_t seed)
    : origin_(origin), perception_(perception, origin, seed), map_node_(network, guide, origin) {}

void WorldNodes::publish_map(std::uint32_t now_ms, map::Vec2 ego, std::vector<wire::Frame>& frames) {
  if (now_ms % kMapUpdate_ms == 10U) {
    map_sender_.update(map_node_.update(ego));
  }
  const int allowed = map_shown_ ? kMapFramesPerTick : kMapFramesPerTickAtStart;
  for (int i = 0; i < allowed; ++i) {
    wire::Frame frame;
    if (!map_sender_.next(now_ms, frame)) {
      map_shown_ = true;
      break;
    }
    frames.push_back(frame);
  }
}

void WorldNodes::publish(std::uint32_t now_ms, const traffic::CarState& ego,
                         const std::vector<traffic::CarState>& others, std::vector<wire::Frame>& frames) {
  if (now_ms % 100U == kPerceptionPhase_ms) {
    perception_.observe(ego, others, now_ms);
  }
  perception_.publish(now_ms, frames);
  publish_map(now_ms, ego.centre, frames);
  if (now_ms % kSlow_ms == 10U) {
    wire::MapOrigin map_origin;
    map_origin.x_m = static_cast<float>(on_the_wire(origin_.x));
    map_origin.y_m = static_cast<float>(on_the_wire(origin_.y));
    append(map_origin, origin_sender_, frames);
    wire::VersionWorld version;
    version.wire_version = wire::wire_version();
    version.layout_hash = wire::layout_hash();
    append(version, version_sender_, frames);
  }
  wire::Tick tick;
  tick.tick = static_cast<std::uint16_t>(now_ms / 10U & 0xFFFFU);
  append(tick, tick_sender_, frames);
}

}  // namespace s4tp::nodes
