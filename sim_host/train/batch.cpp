#include "sim_host/train/batch.hpp"

#include <algorithm>

#include "sim_host/train/fine_samples.hpp"

namespace s4tp::train {
namespace {

using satp::NetworkInput;

template <int kFeatures>
void append(std::vector<float>& values, const float (&row)[kFeatures], const float (&unit)[kFeatures]) {
  for (int i = 0; i < kFeatures; ++i) {
    values.push_back(std::clamp(row[i] / unit[i], -satp::kInputRange, satp::kInputRange));
  }
}

void append_bits(std::vector<float>& values, std::uint32_t bits, int count) {
  for (int i = 0; i < count; ++i)
    values.push_back((bits >> static_cast<unsigned>(i) & 1U) != 0 ? 1.0F : 0.0F);
}

// The first `there` of `count` are.
void append_first(std::vector<float>& values, int there, int count) {
  for (int i = 0; i < count; ++i) values.push_back(i < there ? 1.0F : 0.0F);
}

torch::Tensor tensor_of(const std::vector<float>& values, std::vector<std::int64_t> sizes) {
  return torch::tensor(values, torch::kFloat32).reshape(sizes);
}

torch::Tensor tensor_of(const std::vector<std::int64_t>& values) {
  return torch::tensor(values, torch::kInt64);
}

// Everything a batch is made of, one vehicle after the other.
struct Columns {
  bool full = false;
  std::vector<float> ego_history, ego_mask, place, present, history, history_mask, pair, rule, paths_meet,
      speed, lane, lane_mask, route_mask, plan, target, target_mask, yields, ego_target, ego_known;
  std::vector<std::int64_t> scene, slot, lane_vehicle, lane_slot, route;

  void add_lane(const float (&rows)[satp::kLanePoints][satp::kLaneFeatures], int points) {
    if (full) {
      const FineLane fine = fine_lane(rows, points);
      for (const auto& row : fine.row) append(lane, row, satp::kLaneUnit);
      append_first(lane_mask, fine.points, kFineLanePoints);
    } else {
      for (const auto& row : rows) append(lane, row, satp::kLaneUnit);
      append_first(lane_mask, points, satp::kLanePoints);
    }
  }

  template <int kSteps>
  void add_plan(const float (&steps)[kSteps][satp::kPlanValues]) {
    for (const auto& step : steps) plan.insert(plan.end(), std::begin(step), std::end(step));
  }

  void add_ego_motion(const Sample& sample) {
    const EgoMotion motion = ego_motion(sample);
    ego_known.push_back(motion.known ? 1.0F : 0.0F);
    for (const auto& pose : motion.pose)
      ego_target.insert(ego_target.end(), std::begin(pose), std::end(pose));
  }

  void add_vehicle(const Sample& sample, int index, std::int64_t in_scene) {
    const NetworkInput& input = sample.input;
    const auto vehicle = static_cast<std::int64_t>(speed.size());
    scene.push_back(in_scene);
    slot.push_back(in_scene * (1 + kMaxAgents) + 1 + index);
    for (const auto& row : input.history[index]) append(history, row, satp::kHistoryUnit);
    append_bits(history_mask, input.history_valid[index], kHistorySamples);
    append(pair, input.pair[index], satp::kPairUnit);
    for (const auto feature :
         {satp::PairFeature::kZone, satp::PairFeature::kYields, satp::PairFeature::kHasPriority}) {
      rule.push_back(input.pair[index][static_cast<int>(feature)]);
    }
    paths_meet.push_back(static_cast<float>(input.paths_meet[index]));
    speed.push_back(input.speed_mps[index]);
    for (int path = 0; path < kPathsPerAgent; ++path) {
      const int points = input.lane_points[index][path];
      route_mask.push_back(points > 0 ? 1.0F : 0.0F);
      if (points == 0) continue;
      lane_vehicle.push_back(vehicle);
      lane_slot.push_back(vehicle * kPathsPerAgent + path);
      add_lane(input.lane[index][path], points);
    }
    if (full) {
      add_plan(fine_plan(sample.plan.step[index], input.pair[index]).step);
    } else {
      add_plan(sample.plan.step[index]);
    }
    for (const auto& pose : sample.target.pose[index])
      target.insert(target.end(), std::begin(pose), std::end(pose));
    append_bits(target_mask, sample.target.valid[index], kHorizonSteps);
    route.push_back(sample.route[index]);
    yields.push_back(static_cast<float>(sample.yields[index]));
  }

  void add(const Sample& sample, std::int64_t in_scene) {
    const NetworkInput& input = sample.input;
    for (const auto& row : input.ego_history) append(ego_history, row, satp::kHistoryUnit);
    append_bits(ego_mask, input.ego_history_valid, kHistorySamples);
    for (const auto& row : input.place) append(place, row, satp::kPlaceUnit);
    append_first(present, 1 + input.hdvs, 1 + kMaxAgents);
    if (full) add_ego_motion(sample);
    for (int i = 0; i < input.hdvs; ++i) add_vehicle(sample, i, in_scene);
  }
};

MapChannel random_channel(const satp::NetworkShape& shape, std::int64_t vehicles) {
  const std::int64_t paths = vehicles * kPathsPerAgent;
  MapChannel channel;
  channel.point = torch::randn({paths, shape.lane_points, satp::kLaneFeatures});
  channel.point_mask = torch::ones({paths, shape.lane_points});
  channel.slot = torch::arange(paths, torch::kInt64);
  channel.vehicle = channel.slot.floor_divide(kPathsPerAgent);
  channel.path_mask = torch::ones({vehicles, kPathsPerAgent});
  return channel;
}

}  // namespace

Batch make_batch(const std::vector<const Sample*>& samples, const satp::NetworkShape& shape) {
  Columns columns;
  columns.full = shape.id == satp::kFullShape.id;
  for (std::size_t i = 0; i < samples.size(); ++i) columns.add(*samples[i], static_cast<std::int64_t>(i));
  const auto scenes = static_cast<std::int64_t>(samples.size());
  const auto vehicles = static_cast<std::int64_t>(columns.speed.size());
  const auto lanes = static_cast<std::int64_t>(columns.lane_slot.size());
  Batch batch;
  batch.ego_history = tensor_of(columns.ego_history, {scenes, kHistorySamples, satp::kHistoryFeatures});
  batch.ego_history_mask = tensor_of(columns.ego_mask, {scenes, kHistorySamples});
  batch.place = tensor_of(columns.place, {scenes, 1 + kMaxAgents, satp::kPlaceFeatures});
  batch.present = tensor_of(columns.present, {scenes, 1 + kMaxAgents});
  batch.scene = tensor_of(columns.scene);
  batch.slot = tensor_of(columns.slot);
  batch.history = tensor_of(columns.history, {vehicles, kHistorySamples, satp::kHistoryFeatures});
  batch.history_mask = tensor_of(columns.history_mask, {vehicles, kHistorySamples});
  batch.pair = tensor_of(columns.pair, {vehicles, satp::kPairFeatures});
  batch.rule = tensor_of(columns.rule, {vehicles, 3});
  batch.paths_meet = tensor_of(columns.paths_meet, {vehicles});
  batch.speed_mps = tensor_of(columns.speed, {vehicles});
  batch.lanes.point = tensor_of(columns.lane, {lanes, shape.lane_points, satp::kLaneFeatures});
  batch.lanes.point_mask = tensor_of(columns.lane_mask, {lanes, shape.lane_points});
  batch.lanes.vehicle = tensor_of(columns.lane_vehicle);
  batch.lanes.slot = tensor_of(columns.lane_slot);
  batch.lanes.path_mask = tensor_of(columns.route_mask, {vehicles, kPathsPerAgent});
  batch.plan = tensor_of(columns.plan, {vehicles, shape.decoder_steps, satp::kPlanValues});
  batch.target = tensor_of(columns.target, {vehicles, kHorizonSteps, 3});
  batch.target_mask = tensor_of(columns.target_mask, {vehicles, kHorizonSteps});
  batch.route = tensor_of(columns.route);
  batch.yields = tensor_of(columns.yields, {vehicles});
  if (columns.full) {
    batch.ego_target = tensor_of(columns.ego_target, {scenes, satp::kDecoderSteps, 3});
    batch.ego_known = tensor_of(columns.ego_known, {scenes});
  }
  return batch;
}

torch::Tensor plan_known(const std::vector<const Sample*>& samples) {
  std::vector<float> known;
  for (const Sample* const sample : samples) {
    known.insert(known.end(), static_cast<std::size_t>(sample->input.hdvs),
                 (sample->flags & kNoPlan) != 0 ? 0.0F : 1.0F);
  }
  return torch::tensor(known);
}

Batch random_batch(const satp::NetworkShape& shape, std::int64_t scenes) {
  const std::int64_t vehicles = scenes * kMaxAgents;
  const std::int64_t horizon = shape.decoder_steps * shape.steps_per_decode;
  const auto index = torch::arange(vehicles, torch::kInt64);
  Batch batch;
  batch.ego_history = torch::randn({scenes, kHistorySamples, satp::kHistoryFeatures});
  batch.ego_history_mask = torch::ones({scenes, kHistorySamples});
  batch.place = torch::randn({scenes, 1 + kMaxAgents, satp::kPlaceFeatures});
  batch.present = torch::ones({scenes, 1 + kMaxAgents});
  batch.scene = index.floor_divide(kMaxAgents);
  batch.slot = index + batch.scene + 1;
  batch.history = torch::randn({vehicles, kHistorySamples, satp::kHistoryFeatures});
  batch.history_mask = torch::ones({vehicles, kHistorySamples});
  batch.pair = torch::randn({vehicles, satp::kPairFeatures});
  batch.rule = torch::zeros({vehicles, 3});
  batch.paths_meet = torch::ones({vehicles});
  batch.speed_mps = torch::full({vehicles}, 8.0F);
  batch.lanes = random_channel(shape, vehicles);
  batch.plan = torch::randn({vehicles, shape.decoder_steps, satp::kPlanValues});
  batch.target = torch::randn({vehicles, horizon, 3});
  batch.target_mask = torch::ones({vehicles, horizon});
  batch.route = torch::zeros({vehicles}, torch::kInt64);
  batch.yields = torch::zeros({vehicles});
  if (shape.id == satp::kFullShape.id) {
    batch.crosswalks = random_channel(shape, vehicles);
    batch.ego_target = torch::randn({scenes, satp::kDecoderSteps, 3});
    batch.ego_known = torch::ones({scenes});
  }
  return batch;
}

Batch Batch::to(const torch::Device& device) const {
  Batch moved = *this;
  std::vector<torch::Tensor*> tensors{
      &moved.ego_history, &moved.ego_history_mask, &moved.place,        &moved.present,  &moved.scene,
      &moved.slot,        &moved.history,          &moved.history_mask, &moved.pair,     &moved.rule,
      &moved.paths_meet,  &moved.speed_mps,        &moved.plan,         &moved.target,   &moved.target_mask,
      &moved.route,       &moved.yields,           &moved.ego_target,   &moved.ego_known};
  for (MapChannel* const channel : {&moved.lanes, &moved.crosswalks}) {
    tensors.insert(tensors.end(), {&channel->point, &channel->point_mask, &channel->vehicle, &channel->slot,
                                   &channel->path_mask});
  }
  for (torch::Tensor* const tensor : tensors) {
    if (tensor->defined()) *tensor = tensor->to(device);
  }
  return moved;
}

}  // namespace s4tp::train
