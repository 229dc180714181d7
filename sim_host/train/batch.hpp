#pragma once
/// Samples side by side, as the network reads them: divided by their units, held within the input range, and
/// of vehicles and lane paths only those that are there.

#include <torch/types.h>

#include <cstddef>
#include <vector>

#include "algo/satp/network_shape.hpp"
#include "sim_host/train/sample.hpp"

namespace s4tp::train {

/// L paths of V vehicles.
struct MapChannel {
  torch::Tensor point;       ///< [L, points, features]
  torch::Tensor point_mask;  ///< [L, points]
  torch::Tensor vehicle;     ///< [L] vehicle of a path
  torch::Tensor slot;        ///< [L] of a path among all V paths-per-agent
  torch::Tensor path_mask;   ///< [V, paths]
};

/// B scenes with V vehicles in all; masks are 1 where something is there.
struct Batch {
  torch::Tensor ego_history;       ///< [B, samples, features]
  torch::Tensor ego_history_mask;  ///< [B, samples]
  torch::Tensor place;             ///< [B, 1 + agents, features]
  torch::Tensor present;           ///< [B, 1 + agents]
  torch::Tensor scene;             ///< [V] scene of a vehicle
  torch::Tensor slot;              ///< [V] of a vehicle among all B (1 + agents)
  torch::Tensor history;           ///< [V, samples, features]
  torch::Tensor history_mask;      ///< [V, samples]
  torch::Tensor pair;              ///< [V, features]
  torch::Tensor rule;              ///< [V, 3] zone, yields, has priority
  torch::Tensor paths_meet;        ///< [V] 1 where its paths and ours share something
  torch::Tensor speed_mps;         ///< [V]
  MapChannel lanes;
  MapChannel crosswalks;      ///< of full alone; undefined: none, and no sample has any
  torch::Tensor plan;         ///< [V, steps, values], in metres, radians, m/s
  torch::Tensor target;       ///< [V, horizon, 3] x, y, heading
  torch::Tensor target_mask;  ///< [V, horizon]
  torch::Tensor route;        ///< [V] lane path it took, -1 unknown
  torch::Tensor yields;       ///< [V] 1 it let us pass first, 0 it did not, -1 unknown
  torch::Tensor ego_target;   ///< of full alone: [B, plan steps of a sample, 3] what we drove (EgoMotion)
  torch::Tensor ego_known;    ///< of full alone: [B]

  [[nodiscard]] std::int64_t vehicles() const { return pair.size(0); }
  [[nodiscard]] Batch to(const torch::Device& device) const;
};

/// \param samples  at least one with a vehicle \param shape  full reads them on its finer grid (fine_samples.hpp)
[[nodiscard]] Batch make_batch(const std::vector<const Sample*>& samples, const satp::NetworkShape& shape);

/// [V] 1, or 0 where nobody knows our plan (kNoPlan).
[[nodiscard]] torch::Tensor plan_known(const std::vector<const Sample*>& samples);

/// Random scenes of any shape, for tests of a size that no sample file has.
[[nodiscard]] Batch random_batch(const satp::NetworkShape& shape, std::int64_t scenes);

}  // namespace s4tp::train
