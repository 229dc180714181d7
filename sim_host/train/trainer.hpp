#pragma once
/// The training: batches in an order of their own for each seed, Adam, checkpoints it goes on from.

#include <torch/optim/adam.h>
#include <torch/types.h>

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <future>
#include <vector>

#include "sim_host/train/curve_point.hpp"
#include "sim_host/train/loss.hpp"
#include "sim_host/train/network.hpp"
#include "sim_host/train/sample_file.hpp"

namespace s4tp::train {

/// Values of docs/training.md; what changes the result is all here.
struct TrainingOptions {
  std::uint64_t seed = 1;
  std::int64_t steps = 30000;
  std::int64_t batch = 64;
  double rate = 1e-3;                 ///< of Adam, at most: it falls to 0 along half a cosine
  double clip = 5.0;                  ///< of the gradient's norm
  double no_plan = 0.2;               ///< share of scenes whose plan the network is not shown
  double rough = 0.6;                 ///< share of scenes whose tracks are roughened (rough_tracks.hpp)
  bool forks = true;                  ///< false: only what the ego did by itself is learned from
  std::filesystem::path integers;     ///< a trained network to go on from with the ECU's rounding in it
  std::filesystem::path teacher;      ///< a trained network of size teacher to learn from as well
  std::int64_t passes = 15;           ///< no scene is seen more often
  std::int64_t validate_every = 500;  ///< steps
};

/// Steps these options take over so many training samples.
[[nodiscard]] std::int64_t steps_of(const TrainingOptions& options, std::size_t samples);

class Trainer {
 public:
  /// \param set  must outlive the trainer \throws std::runtime_error when a part of it is empty
  Trainer(const satp::NetworkShape& shape, const TrainingOptions& options, const SampleSet& set);

  /// Trains to the end, or to the next whole step after `stop` is set.
  /// TRAIN-004 On one kind of processor, with one thread count, the same options and samples give the same
  /// bits, interrupted or not. \param told  after each point of the curve
  void run(const std::atomic<bool>& stop, const std::function<void(const CurvePoint&)>& told);

  [[nodiscard]] bool finished() const { return step_ >= steps_; }
  [[nodiscard]] std::int64_t step() const { return step_; }
  [[nodiscard]] std::int64_t steps() const { return steps_; }
  [[nodiscard]] const std::vector<CurvePoint>& curve() const { return curve_; }
  [[nodiscard]] Network& network() { return *network_; }

  /// The whole state of the training; under its name only when it is all there.
  void save(const std::filesystem::path& file) const;
  /// \throws std::runtime_error when the file is of another shape, or of other options or data
  void load(const std::filesystem::path& file);

 private:
  /// What a step is given: scenes, and which vehicles are told our plan.
  struct StepInput {
    Batch batch;
    torch::Tensor has_plan;
  };
  [[nodiscard]] StepInput input_of(std::int64_t step);
  void train_step();
  [[nodiscard]] CurvePoint sums() const;
  void validate(CurvePoint& point);
  [[nodiscard]] Loss loss_with_teacher(const Batch& batch, const Encoded& encoded, const Decoded& decoded,
                                       const torch::Tensor& has_plan);
  [[nodiscard]] torch::Tensor fingerprint() const;

  TrainingOptions options_;
  const SampleSet& set_;
  std::vector<std::size_t> training_;
  std::vector<std::size_t> validation_;
  torch::Device device_;
  std::shared_ptr<Network> network_;
  std::shared_ptr<Network> teacher_;  ///< null: none
  torch::optim::Adam adam_;
  std::int64_t steps_;
  std::int64_t step_ = 0;
  std::int64_t pass_ = -1;          ///< whose order `order_` is
  std::vector<std::size_t> order_;  ///< of the training samples
  double gradient_ = 0.0;           ///< sum of its norms since the last point
  double rate_ = 0.0;
  torch::Tensor
      losses_;  ///< sums of the loss's parts since then; on the device, so that no step waits for them
  std::vector<CurvePoint> curve_;
  std::future<StepInput> ahead_;  ///< the next step's, made while this one runs; last, as it reads the others
};

/// A GPU where torch finds one.
[[nodiscard]] torch::Device best_device();

/// Threads of torch and of the linear algebra below it; before any other call of torch.
void use_threads(int count);

/// How a checkpoint came about.
struct TrainedFor {
  int shape = 0;  ///< NetworkShape::id
  std::int64_t steps = 0;
  std::uint64_t seed = 0;
};
/// \throws std::runtime_error when it is none
[[nodiscard]] TrainedFor read_trained_for(const std::filesystem::path& checkpoint);

/// A trained network out of a checkpoint, on the CPU. \throws std::runtime_error when there is none of this shape
[[nodiscard]] std::shared_ptr<Network> load_network(const satp::NetworkShape& shape,
                                                    const std::filesystem::path& checkpoint);

}  // namespace s4tp::train
