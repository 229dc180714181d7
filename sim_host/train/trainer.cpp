#include "sim_host/train/trainer.hpp"

#include <dlfcn.h>
#include <malloc.h>
#include <torch/cuda.h>
#include <torch/nn/utils/clip_grad.h>
#include <torch/serialize.h>
#include <torch/utils.h>

#include <algorithm>
#include <cmath>
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

constexpr int kCurveColumns = 10;
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
  const auto trained = load_network(network.shape(), checkpoint);
  const torch::NoGradGuard no_gradient;
  const auto from = trained->named_parameters();
  for (auto& parameter : network.named_parameters()) parameter.value().copy_(from[parameter.key()]);
  network.round_as_integers(calibrated_ranges(trained->arrays(), set, export_samples(set)));
}

void write_ranges(torch::serialize::OutputArchive& archive, const Ranges& ranges) {
  for (const auto& [layer, range] : ranges) archive.write(layer, torch::tensor({range.low, range.high}));
}

Ranges read_ranges(torch::serialize::InputArchive& archive) {
  Ranges ranges;
  for (const std::string& layer : archive.keys()) {
    Tensor range;
    archive.read(layer, range);
    ranges[layer] = {range[0].item<float>(), range[1].item<float>()};
  }
  return ranges;
}

std::shared_ptr<Network> new_network(const satp::NetworkShape& shape, const TrainingOptions& options,
                                     const SampleSet& set, torch::Device device) {
  torch::manual_seed(options.seed);
  auto network = std::make_shared<Network>(shape);
  if (!options.integers.empty()) take_integers(*network, options.integers, set);
  network->to(device);
  return network;
}

torch::Device best_device() {
  return torch::cuda::is_available() ? torch::kCUDA : torch::kCPU;
}

Tensor row_of(const CurvePoint& point) {
  return torch::tensor(
      {static_cast<double>(point.step), point.position, point.mode, point.route, point.yields, point.gradient,
       point.rate, point.validation, point.top_1_m, point.best_of_modes_m},
      torch::kFloat64);
}

CurvePoint point_of(const Tensor& row) {
  const double* value = row.data_ptr<double>();
  return {static_cast<std::int64_t>(value[0]),
          value[1],
          value[2],
          value[3],
          value[4],
          value[5],
          value[6],
          value[7],
          value[8],
          value[9]};
}

}  // namespace

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
      adam_(network_->parameters(), torch::optim::AdamOptions(options.rate)),
      steps_(steps_of(options, training_.size())) {
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

Batch Trainer::next_batch(std::vector<float>& has_plan) {
  const std::int64_t batches = static_cast<std::int64_t>(training_.size()) / options_.batch;
  const std::int64_t pass = step_ / batches;
  if (pass != pass_) {
    order_ = training_;
    shuffle(order_, options_.seed + kOrder + static_cast<std::uint64_t>(pass));
    pass_ = pass;
  }
  std::vector<Sample> scenes(static_cast<std::size_t>(options_.batch));
  std::vector<const Sample*> samples;
  for (std::int64_t i = 0; i < options_.batch; ++i) {
    Sample& sample = scenes[static_cast<std::size_t>(i)];
    sample = set_[order_[static_cast<std::size_t>(step_ % batches * options_.batch + i)]];
    samples.push_back(&sample);
    const auto draw = static_cast<std::uint64_t>(step_ * options_.batch + i);
    if (random_share(options_.seed + kRough, draw) < options_.rough) {
      roughen_tracks(random_share(options_.seed + kHowRough, draw),
                     random_number(options_.seed + kHowRough, draw), sample.input);
    }
    const bool hidden =
        (sample.flags & kNoPlan) != 0 || random_share(options_.seed + kHidePlan, draw) < options_.no_plan;
    has_plan.insert(has_plan.end(), static_cast<std::size_t>(sample.input.hdvs), hidden ? 0.0F : 1.0F);
  }
  return make_batch(samples).to(device_);
}

void Trainer::train_step() {
  std::vector<float> has_plan;
  const Batch batch = next_batch(has_plan);
  const double rate = options_.rate * share_of_rate(step_, steps_);
  static_cast<torch::optim::AdamOptions&>(adam_.param_groups()[0].options()).lr(rate);
  adam_.zero_grad();
  const Encoded encoded = network_->encode(batch);
  const Decoded decoded = network_->decode(batch, encoded, torch::tensor(has_plan).to(device_));
  const Loss loss = loss_of(batch, encoded, decoded);
  loss.total.backward();
  const double gradient = torch::nn::utils::clip_grad_norm_(network_->parameters(), options_.clip);
  if (!std::isfinite(gradient)) {
    throw std::runtime_error("the gradient is not finite at step " + std::to_string(step_));
  }
  adam_.step();
  ++step_;
  sums_.position += loss.position.item<double>();
  sums_.mode += loss.mode.item<double>();
  sums_.route += loss.route.item<double>();
  sums_.yields += loss.yields.item<double>();
  sums_.gradient += gradient;
  sums_.rate = rate;
}

void Trainer::validate(CurvePoint& point) {
  const torch::NoGradGuard no_gradient;
  double vehicles = 0.0;
  for (std::size_t from = 0; from < validation_.size(); from += 256) {
    std::vector<const Sample*> samples;
    for (std::size_t i = from; i < std::min(from + 256, validation_.size()); ++i) {
      samples.push_back(&set_[validation_[i]]);
    }
    const Batch batch = make_batch(samples).to(device_);
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
    CurvePoint point = sums_;
    const auto count = static_cast<double>(since);
    point.step = step_;
    point.position /= count;
    point.mode /= count;
    point.route /= count;
    point.yields /= count;
    point.gradient /= count;
    validate(point);
    curve_.push_back(point);
    sums_ = {};
    told(point);
  }
}

// What a checkpoint must agree with: sizes, options that change the result, and the data.
Tensor Trainer::fingerprint() const {
  double data = 0.0;
  for (std::size_t i = 0; i < training_.size(); i += 1 + training_.size() / 1000) {
    data += set_[training_[i]].input.speed_mps[0] + static_cast<double>(set_[training_[i]].road % 1000);
  }
  std::vector<double> print{static_cast<double>(network_->shape().id),
                            static_cast<double>(options_.seed),
                            static_cast<double>(steps_),
                            static_cast<double>(options_.batch),
                            options_.rate,
                            options_.clip,
                            options_.no_plan,
                            options_.rough,
                            static_cast<double>(options_.validate_every),
                            static_cast<double>(training_.size()),
                            data};
  if (const IntegerRounding* const rounding = network_->rounding()) {
    for (const auto& [layer, range] : rounding->calibrated()) print.push_back(range.magnitude());
  }
  return torch::tensor(print, torch::kFloat64);
}

void Trainer::save(const std::filesystem::path& file) const {
  torch::serialize::OutputArchive archive, network, adam;
  network_->save(network);
  adam_.save(adam);
  archive.write("network", network);
  archive.write("adam", adam);
  if (const IntegerRounding* const rounding = network_->rounding()) {
    torch::serialize::OutputArchive ranges;
    write_ranges(ranges, rounding->calibrated());
    archive.write("calibrated", ranges);
  }
  archive.write("fingerprint", fingerprint());
  archive.write("step", torch::tensor(step_, torch::kInt64));
  archive.write("sums", row_of(sums_));
  std::vector<Tensor> rows;
  for (const CurvePoint& point : curve_) rows.push_back(row_of(point));
  archive.write("curve",
                rows.empty() ? torch::empty({0, kCurveColumns}, torch::kFloat64) : torch::stack(rows));
  const std::filesystem::path unfinished = file.string() + ".part";
  archive.save_to(unfinished.string());
  std::filesystem::rename(unfinished, file);
}

void Trainer::load(const std::filesystem::path& file) {
  torch::serialize::InputArchive archive, network, adam;
  archive.load_from(file.string());
  Tensor print, step, sums, curve;
  archive.read("fingerprint", print);
  if (!torch::equal(print, fingerprint())) {
    throw std::runtime_error(file.string() + " is of another training: other options, size or data");
  }
  archive.read("network", network);
  archive.read("adam", adam);
  archive.read("step", step);
  archive.read("sums", sums);
  archive.read("curve", curve);
  network_->load(network);
  adam_.load(adam);
  step_ = step.item<std::int64_t>();
  sums_ = point_of(sums);
  curve_.clear();
  for (std::int64_t i = 0; i < curve.size(0); ++i) curve_.push_back(point_of(curve[i].contiguous()));
  pass_ = -1;
}

void use_threads(int count) {
  // Tensors come and go by the thousand: pages given back each time cost a fifth of the run.
  mallopt(M_MMAP_THRESHOLD, 1 << 30);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
  torch::set_num_threads(count);
  at::globalContext().setDeterministicAlgorithms(true, false);
  using SetThreads = void (*)(int);
  // OpenBLAS has its own threads, and torch does not know of them.
  if (const auto set = reinterpret_cast<SetThreads>(dlsym(RTLD_DEFAULT, "openblas_set_num_threads")))
    set(count);
}

TrainedFor read_trained_for(const std::filesystem::path& checkpoint) {
  torch::serialize::InputArchive archive;
  Tensor print, step;
  try {
    archive.load_from(checkpoint.string());
    archive.read("fingerprint", print);
    archive.read("step", step);
  } catch (const c10::Error&) {
    throw std::runtime_error(checkpoint.string() + ": no checkpoint of a training");
  }
  return {print[0].item().toInt(), step.item<std::int64_t>(),
          static_cast<std::uint64_t>(print[1].item<double>())};
}

std::shared_ptr<Network> load_network(const satp::NetworkShape& shape,
                                      const std::filesystem::path& checkpoint) {
  // Torch would take tensors of any size.
  if (read_trained_for(checkpoint).shape != shape.id) {
    throw std::runtime_error(checkpoint.string() + ": a network of another size");
  }
  auto network = std::make_shared<Network>(shape);
  torch::serialize::InputArchive archive, stored;
  archive.load_from(checkpoint.string());
  torch::serialize::InputArchive calibrated;
  if (archive.try_read("calibrated", calibrated)) network->round_as_integers(read_ranges(calibrated));
  archive.read("network", stored);
  network->load(stored);
  return network;
}

}  // namespace s4tp::train
