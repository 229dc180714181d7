#include "sim_host/train/trainer.hpp"

#include <dlfcn.h>
#include <malloc.h>
#include <torch/cuda.h>
#include <torch/nn/utils/clip_grad.h>
#include <torch/utils.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <stdexcept>
#include <string>

#include "sim_host/train/image_export.hpp"
#include "sim_host/train/random_number.hpp"
#include "sim_host/train/rough_tracks.hpp"

namespace s4tp::train {
namespace {

using torch::Tensor;

// What a random number is for, on top of the seed.
enum Purpose : std::uint64_t { kOrder = 1000, kHidePlan = 2000, kRough = 3000, kHowRough = 4000 };

constexpr double kWarmUpShare = 0.02;                 // of the steps
constexpr std::size_t kMostValidationSamples = 2048;  // enough for a curve; the figures take all

// Up in a straight line while Adam's moments are of few batches, then down along half a cosine, so that the
// weights that are kept are not those of the last batches.
double share_of_rate(std::int64_t step, std::int64_t steps) {
  const double passed = static_cast<double>(step) / static_cast<double>(steps);
  return std::min(1.0, passed / kWarmUpShare) * 0.5 * (1.0 + std::cos(std::numbers::pi * passed));
}

// Goes on from a trained network, with the ECU's rounding in it.
void take_integers(Network& network, const std::filesystem::path& checkpoint, const SampleSet& set) {
  if (network.shape().id != satp::kMcuShape.id)
    throw std::runtime_error("only the size mcu has integers to learn with");
  const auto trained = load_network(network.shape(), checkpoint);
  const torch::NoGradGuard no_gradient;
  const auto from = trained->named_parameters();
  for (auto& parameter : network.named_parameters()) parameter.value().copy_(from[parameter.key()]);
  network.round_as_integers(calibrated_ranges(trained->arrays(), set, export_samples(set)));
}

std::shared_ptr<Network> new_network(const satp::NetworkShape& shape, const TrainingOptions& options,
                                     const SampleSet& set, torch::Device device) {
  torch::manual_seed(options.seed);
  auto network = std::make_shared<Network>(shape);
  if (!options.integers.empty()) take_integers(*network, options.integers, set);
  network->to(device);
  return network;
}

// The network that is learned from.
std::shared_ptr<Network> teacher_of(const TrainingOptions& options, const satp::NetworkShape& shape,
                                    torch::Device device) {
  if (options.teacher.empty()) return nullptr;
  if (shape.id == satp::kFullShape.id)
    throw std::runtime_error(
        "the size full reads scenes on a finer grid than a teacher: it learns from none");
  auto teacher = load_network(satp::kTeacherShape, options.teacher);
  teacher->to(device);
  return teacher;
}

// The parts of the loss that the curve tells, in its order.
Tensor parts_of(const Loss& loss) {
  return torch::stack({loss.position, loss.mode, loss.route, loss.yields, loss.ego})
      .detach()
      .to(torch::kFloat64);
}

// Later versions of torch would fill each new tensor, so that nobody reads what was there before: nobody does.
template <class Context>
void leave_unfilled(Context& context) {
  if constexpr (requires { context.setDeterministicFillUninitializedMemory(false); })
    context.setDeterministicFillUninitializedMemory(false);
}

}  // namespace

torch::Device best_device() {
  return torch::cuda::is_available() ? torch::kCUDA : torch::kCPU;
}

std::int64_t steps_of(const TrainingOptions& options, std::size_t samples) {
  const auto pass = static_cast<std::int64_t>(samples) / options.batch;
  return std::min(options.steps, options.passes * pass);
}

Trainer::Trainer(const satp::NetworkShape& shape, const TrainingOptions& options, const SampleSet& set)
    : options_(options),
      set_(set),
      training_(samples_of(set, Part::kTraining)),
      validation_(samples_of(set, Part::kValidation)),
      device_(best_device()),
      network_(new_network(shape, options, set, device_)),
      teacher_(teacher_of(options, shape, device_)),
      adam_(network_->parameters(), torch::optim::AdamOptions(options.rate)),
      steps_(steps_of(options, training_.size())),
      losses_(torch::zeros({5}, torch::TensorOptions(device_).dtype(torch::kFloat64))) {
  const auto alone = [&](std::size_t i) { return set_[i].input.hdvs == 0; };
  std::erase_if(training_, alone);
  std::erase_if(validation_, alone);
  // Observations instead of interventions; judged by the same validation.
  if (!options.forks) std::erase_if(training_, [&](std::size_t i) { return set_[i].branch != 0; });
  steps_ = steps_of(options, training_.size());
  if (steps_ == 0) throw std::runtime_error("fewer training samples with traffic than one batch");
  if (validation_.empty()) throw std::runtime_error("no validation samples with traffic");
  shuffle(validation_, options.seed);
  validation_.resize(std::min(validation_.size(), kMostValidationSamples));
}

Trainer::StepInput Trainer::input_of(std::int64_t step) {
  const std::int64_t batches = static_cast<std::int64_t>(training_.size()) / options_.batch;
  const std::int64_t pass = step / batches;
  if (pass != pass_) {
    order_ = training_;
    shuffle(order_, options_.seed + kOrder + static_cast<std::uint64_t>(pass));
    pass_ = pass;
  }
  std::vector<Sample> scenes(static_cast<std::size_t>(options_.batch));
  std::vector<const Sample*> samples;
  std::vector<float> has_plan;
  for (std::int64_t i = 0; i < options_.batch; ++i) {
    Sample& sample = scenes[static_cast<std::size_t>(i)];
    sample = set_[order_[static_cast<std::size_t>(step % batches * options_.batch + i)]];
    samples.push_back(&sample);
    const auto draw = static_cast<std::uint64_t>(step * options_.batch + i);
    if (random_share(options_.seed + kRough, draw) < options_.rough) {
      roughen_tracks(random_share(options_.seed + kHowRough, draw),
                     random_number(options_.seed + kHowRough, draw), sample.input);
    }
    const bool hidden =
        (sample.flags & kNoPlan) != 0 || random_share(options_.seed + kHidePlan, draw) < options_.no_plan;
    has_plan.insert(has_plan.end(), static_cast<std::size_t>(sample.input.hdvs), hidden ? 0.0F : 1.0F);
  }
  return {make_batch(samples, network_->shape()).to(device_), torch::tensor(has_plan).to(device_)};
}

Loss Trainer::loss_with_teacher(const Batch& batch, const Encoded& encoded, const Decoded& decoded,
                                const Tensor& has_plan) {
  if (teacher_ == nullptr) return loss_of(batch, encoded, decoded);
  const Decoded expected = [&] {
    const torch::NoGradGuard no_gradient;
    return teacher_->decode(batch, teacher_->encode(batch), has_plan);
  }();
  return loss_of(batch, encoded, decoded, &expected);
}

void Trainer::train_step() {
  const auto [batch, has_plan] = ahead_.valid() ? ahead_.get() : input_of(step_);
  if (step_ + 1 < steps_)
    ahead_ = std::async(std::launch::async, [this, next = step_ + 1] { return input_of(next); });
  rate_ = options_.rate * share_of_rate(step_, steps_);
  static_cast<torch::optim::AdamOptions&>(adam_.param_groups()[0].options()).lr(rate_);
  adam_.zero_grad();
  const Encoded encoded = network_->encode(batch);
  const Decoded decoded = network_->decode(batch, encoded, has_plan);
  const Loss loss = loss_with_teacher(batch, encoded, decoded, has_plan);
  loss.total.backward();
  const double gradient = torch::nn::utils::clip_grad_norm_(network_->parameters(), options_.clip);
  if (!std::isfinite(gradient)) {
    throw std::runtime_error("the gradient is not finite at step " + std::to_string(step_));
  }
  adam_.step();
  ++step_;
  losses_ += parts_of(loss);
  gradient_ += gradient;
}

// Since the last point; not divided yet.
CurvePoint Trainer::sums() const {
  const Tensor losses = losses_.to(torch::kCPU);
  const double* loss = losses.data_ptr<double>();
  CurvePoint sums;
  sums.position = loss[0];
  sums.mode = loss[1];
  sums.route = loss[2];
  sums.yields = loss[3];
  sums.ego = loss[4];
  sums.gradient = gradient_;
  sums.rate = rate_;
  return sums;
}

void Trainer::validate(CurvePoint& point) {
  const torch::NoGradGuard no_gradient;
  double vehicles = 0.0;
  for (std::size_t from = 0; from < validation_.size(); from += 256) {
    std::vector<const Sample*> samples;
    for (std::size_t i = from; i < std::min(from + 256, validation_.size()); ++i) {
      samples.push_back(&set_[validation_[i]]);
    }
    const Batch batch = make_batch(samples, network_->shape()).to(device_);
    const Encoded encoded = network_->encode(batch);
    const Decoded decoded = network_->decode(batch, encoded, plan_known(samples).to(device_));
    const Tensor distance = mean_distance_m(batch, decoded);
    const Tensor seen = (batch.target_mask.sum(1) > 0).to(torch::kFloat32);
    const double weight = seen.sum().item<double>();
    vehicles += weight;
    point.validation += weight * loss_of(batch, encoded, decoded).total.item<double>();
    const Tensor likeliest = distance.gather(1, decoded.score.argmax(1, true)).squeeze(1);
    point.top_1_m += (likeliest * seen).sum().item<double>();
    point.best_of_modes_m += (std::get<0>(distance.min(1)) * seen).sum().item<double>();
  }
  vehicles = std::max(vehicles, 1.0);
  point.validation /= vehicles;
  point.top_1_m /= vehicles;
  point.best_of_modes_m /= vehicles;
}

void Trainer::run(const std::atomic<bool>& stop, const std::function<void(const CurvePoint&)>& told) {
  while (!finished() && !stop) {
    train_step();
    const std::int64_t since = step_ - (curve_.empty() ? 0 : curve_.back().step);
    if (since < options_.validate_every && !finished()) continue;
    CurvePoint point = sums();
    const auto count = static_cast<double>(since);
    point.step = step_;
    point.position /= count;
    point.mode /= count;
    point.route /= count;
    point.yields /= count;
    point.ego /= count;
    point.gradient /= count;
    validate(point);
    curve_.push_back(point);
    losses_.zero_();
    gradient_ = 0.0;
    told(point);
  }
}

void use_threads(int count) {
  // Tensors come and go by the thousand: pages given back each time cost a fifth of the run.
  mallopt(M_MMAP_THRESHOLD, 1 << 30);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
  setenv("CUBLAS_WORKSPACE_CONFIG", ":4096:8", 0);  // without it a GPU's sums are not the same each time
  torch::set_num_threads(count);
  // A GPU may lack a kernel that always gives the same bits: torch then says so and takes what there is.
  at::globalContext().setDeterministicAlgorithms(true, torch::cuda::is_available());
  leave_unfilled(at::globalContext());
  using SetThreads = void (*)(int);
  // OpenBLAS has its own threads, and torch does not know of them.
  if (const auto set = reinterpret_cast<SetThreads>(dlsym(RTLD_DEFAULT, "openblas_set_num_threads")))
    set(count);
}

}  // namespace s4tp::train
