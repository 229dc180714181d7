// What a training leaves in a file: the network, Adam's moments, the curve so far.

#include <torch/serialize.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "sim_host/train/trainer.hpp"

namespace s4tp::train {
namespace {

using torch::Tensor;

constexpr int kCurveColumns = 11;

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

Tensor row_of(const CurvePoint& point) {
  return torch::tensor(
      {static_cast<double>(point.step), point.position, point.mode, point.route, point.yields, point.ego,
       point.gradient, point.rate, point.validation, point.top_1_m, point.best_of_modes_m},
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
          value[9],
          value[10]};
}

// Where a checkpoint was written does not matter: what was on a GPU there may be on the CPU here.
Tensor read_small(torch::serialize::InputArchive& archive, const char* name) {
  Tensor tensor;
  archive.read(name, tensor);
  return tensor.to(torch::kCPU);
}

}  // namespace

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
  if (teacher_ != nullptr) {
    double taught = 0.0;
    for (const Tensor& parameter : teacher_->parameters()) taught += parameter.abs().sum().item<double>();
    print.push_back(taught);
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
  archive.write("sums", row_of(sums()));
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
  archive.load_from(file.string(), device_);
  if (!torch::equal(read_small(archive, "fingerprint"), fingerprint())) {
    throw std::runtime_error(file.string() + " is of another training: other options, size or data");
  }
  const Tensor curve = read_small(archive, "curve");
  if (curve.size(1) != kCurveColumns) throw std::runtime_error(file.string() + " is of an earlier program");
  archive.read("network", network);
  archive.read("adam", adam);
  network_->load(network);
  adam_.load(adam);
  step_ = read_small(archive, "step").item<std::int64_t>();
  const CurvePoint sums = point_of(read_small(archive, "sums"));
  losses_.copy_(
      torch::tensor({sums.position, sums.mode, sums.route, sums.yields, sums.ego}, torch::kFloat64));
  gradient_ = sums.gradient;
  rate_ = sums.rate;
  curve_.clear();
  for (std::int64_t i = 0; i < curve.size(0); ++i) curve_.push_back(point_of(curve[i].contiguous()));
  ahead_ = {};
  pass_ = -1;
}

TrainedFor read_trained_for(const std::filesystem::path& checkpoint) {
  torch::serialize::InputArchive archive;
  Tensor print, step;
  try {
    archive.load_from(checkpoint.string(), torch::Device(torch::kCPU));
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
  archive.load_from(checkpoint.string(), torch::Device(torch::kCPU));
  torch::serialize::InputArchive calibrated;
  if (archive.try_read("calibrated", calibrated)) network->round_as_integers(read_ranges(calibrated));
  archive.read("network", stored);
  network->load(stored);
  return network;
}

}  // namespace s4tp::train
