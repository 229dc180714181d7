#include "sim_host/train/activation_scales.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace s4tp::train {

using satp::Format;
using satp::LayerInfo;

std::string block_of(const std::string& name) {
  return name.substr(0, name.rfind('.'));
}

std::string part_of(const std::string& name) {
  return name.substr(name.rfind('.') + 1);
}

bool wide(const LayerInfo& info) {
  return info.input == Format::kQ13 || info.input == Format::kQ15;
}

double ActivationScales::magnitude(const std::string& name) const {
  const auto found = ranges_.find(name);
  if (found == ranges_.end() || !(found->second.magnitude() > 0.0F) ||
      !std::isfinite(found->second.magnitude()))
    throw std::runtime_error("no range of " + name + " was seen");
  return found->second.magnitude();
}

Scale ActivationScales::history() const {
  return {
      std::max(magnitude("ego_history.attention.norm_2"), magnitude("hdv_history.attention.norm_2")) / kMost8,
      0.0};
}

double ActivationScales::embed_unit() const {
  return std::max({magnitude("own.embed"), magnitude("plan.embed"), largest_null_plan_}) / kEmbedUnits;
}

Scale ActivationScales::query_of(const std::string& block) const {
  if (block == "ego_history.attention") return int8("ego_history.embed_2");
  if (block == "hdv_history.attention") return int8("hdv_history.embed_2");
  if (block == "agent_1") return {64.0 * units("token.add"), 0.0};
  if (block == "agent_2") return {64.0 * units("agent_2.input"), 0.0};
  return int8("agent_2.norm_2");
}

Scale ActivationScales::keys_of(const std::string& block) const {
  if (block == "lane") return relu("map.point_2");
  if (block == "route") return int8("lane.norm_2");
  return query_of(block);
}

std::vector<Segment> ActivationScales::inputs_of(const LayerInfo& info) const {
  const std::string name = info.name;
  const std::string block = block_of(name);
  const std::string part = part_of(name);
  const int width = shape_.width;
  const int embed = shape_.embed;
  const int hidden = shape_.hidden;
  const Scale state8{1.0 / 128.0, 0.0};
  const auto whole = [&](const Scale& scale) { return std::vector<Segment>{{info.columns, scale}}; };
  if (info.input == Format::kQ13) return whole({1.0 / 8192.0, 0.0});
  if (info.input == Format::kQ15) return whole({1.0 / 32768.0, 0.0});
  if (part == "embed_2") return whole(relu(block + ".embed_1"));
  if (part == "query") return whole(query_of(block));
  if (part == "key" || part == "value") return whole(keys_of(block));
  if (part == "output") return whole(int8(block + ".value"));
  if (part == "expand") return whole(int8(block + ".norm_1"));
  if (part == "contract") return whole(relu(block + ".expand"));
  if (name == "map.point_2") return whole(relu("map.point_1"));
  if (name == "pair.pair_2") return whole(relu("pair.pair_1"));
  if (name == "gate.gate_1") return {{width, history()}, {width, history()}, {width, relu("pair.pair_2")}};
  if (name == "gate.gate_2") return whole(relu("gate.gate_1"));
  if (name == "start.state")
    return {{width, int8("agent_2.norm_2")}, {width, int8("route.norm_2")}, {width, relu("pair.pair_2")}};
  if (name == "gru.gates") return {{embed, relu("gru.mix")}, {hidden, state8}};
  if (name == "gru.input") return whole(relu("gru.mix"));
  if (name == "gru.state") return whole(state8);
  throw std::logic_error("no input is known of " + name);
}

double ActivationScales::output_scale(const LayerInfo& info) const {
  const std::string name = info.name;
  const std::string block = block_of(name);
  switch (info.output) {
    case Format::kInt8:
      return int8(name).scale;
    case Format::kInt8Relu:
      return relu(name).scale;
    case Format::kInt16Relu:
      return embed_unit();
    case Format::kQ12:
      return 1.0 / 4096.0;
    case Format::kInt16:
      if (name == "place.embed") return units("token.add");
      return units(block + (part_of(name) == "output" ? ".add_1" : ".add_2"));
    default:
      break;
  }
  throw std::logic_error("no output scale is known of " + name);
}

}  // namespace s4tp::train
