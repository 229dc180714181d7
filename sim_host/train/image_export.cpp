#include "sim_host/train/image_export.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <string>

#include "algo/satp/decoder.hpp"
#include "sim_host/train/random_number.hpp"

namespace s4tp::train {
namespace {

constexpr int kWordsALine = 8;
constexpr std::size_t kExportSamples = 512;
constexpr double kUsual = 0.95;
constexpr int kResidualStep = 4;                  // 0.5 s
constexpr std::uintmax_t kMostBytes = 1U << 20U;  // several flash banks

std::ofstream opened(const std::filesystem::path& file) {
  std::ofstream out(file, std::ios::binary);
  if (!out) throw std::runtime_error(file.string() + " cannot be written");
  return out;
}

// How far the likeliest future of each vehicle is off after 0.5 s; the network sees each with plan and without.
std::vector<float> residuals_of(FloatNetwork& network, const SampleSet& set,
                                const std::vector<std::size_t>& samples, float temperature) {
  std::vector<float> residuals_m;
  for (const std::size_t i : samples) {
    const Sample& sample = set[i];
    const FloatEncoded encoded = network.encode(sample.input);
    for (int vehicle = 0; vehicle < sample.input.hdvs; ++vehicle) {
      (void)network.decode(encoded, sample.input, vehicle, nullptr, temperature);
      const FloatFutures futures = network.decode(encoded, sample.input, vehicle, &sample.plan, temperature);
      if ((sample.target.valid[vehicle] >> static_cast<unsigned>(kResidualStep) & 1U) == 0) continue;
      const auto likeliest =
          std::max_element(std::begin(futures.probability), std::end(futures.probability)) -
          futures.probability;
      const float(&expected)[3] = futures.pose[likeliest][kResidualStep];
      const float(&truth)[3] = sample.target.pose[vehicle][kResidualStep];
      residuals_m.push_back(std::hypot(expected[0] - truth[0], expected[1] - truth[1]));
    }
  }
  return residuals_m;
}

// What all but the worst twentieth stay below.
float usual_residual_m(std::vector<float> residuals_m) {
  if (residuals_m.empty())
    throw std::runtime_error("no vehicle among the calibration samples was seen for 0.5 s");
  const auto rank = static_cast<std::ptrdiff_t>(kUsual * static_cast<double>(residuals_m.size() - 1));
  std::nth_element(residuals_m.begin(), residuals_m.begin() + rank, residuals_m.end());
  return residuals_m[static_cast<std::size_t>(rank)];
}

}  // namespace

std::vector<std::size_t> export_samples(const SampleSet& set) {
  std::vector<std::size_t> samples = samples_of(set, Part::kCalibration);
  shuffle(samples, 0);
  samples.resize(std::min(samples.size(), kExportSamples));
  return samples;
}

Ranges calibrated_ranges(const Tensors& tensors, const SampleSet& set,
                         const std::vector<std::size_t>& samples) {
  FloatNetwork network(satp::kMcuShape, tensors);
  (void)residuals_of(network, set, samples, 1.0F);
  return network.ranges();
}

std::vector<std::uint32_t> export_image(const Trained& trained, const SampleSet& set,
                                        const std::vector<std::size_t>& samples) {
  FloatNetwork network(satp::kMcuShape, trained.tensors);
  const std::vector<float> residuals_m = residuals_of(network, set, samples, trained.temperature);
  return quantize(network, trained.ranges.value_or(network.ranges()),
                  {trained.temperature, usual_residual_m(residuals_m), trained.steps, trained.seed});
}

void write_image(const std::vector<std::uint32_t>& image, const std::filesystem::path& file) {
  std::ofstream out = opened(file);
  for (const std::uint32_t word : image) {  // little endian, whatever the host
    for (unsigned shift = 0; shift < 32; shift += 8) out.put(static_cast<char>(word >> shift & 0xFFU));
  }
  if (!out.flush()) throw std::runtime_error(file.string() + " cannot be written");
}

void write_image_words(const std::vector<std::uint32_t>& image, const std::filesystem::path& file) {
  std::ofstream out = opened(file);
  out << "// Written by ./s4tp train export; not edited by hand.";
  for (std::size_t i = 0; i < image.size(); ++i) {
    char text[16];
    std::snprintf(text, sizeof text, "%s0x%08XU,", i % kWordsALine == 0 ? "\n" : " ", image[i]);
    out << text;
  }
  out << '\n';
  if (!out.flush()) throw std::runtime_error(file.string() + " cannot be written");
}

std::vector<std::uint32_t> read_image(const std::filesystem::path& file) {
  if (!std::filesystem::is_regular_file(file) || std::filesystem::file_size(file) > kMostBytes)
    throw std::runtime_error(file.string() + ": no image of weights");
  std::ifstream in(file, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  if (bytes.empty() || bytes.size() % 4 != 0)
    throw std::runtime_error(file.string() + ": no image of weights");
  std::vector<std::uint32_t> image(bytes.size() / 4);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    image[i / 4] |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[i])) << (8U * (i % 4));
  }
  return image;
}

Forecasts image_forecasts(const std::vector<std::uint32_t>& image, const SampleSet& set,
                          const std::vector<std::size_t>& samples, bool with_plan) {
  satp::Weights weights;
  const satp::WeightStatus status =
      satp::Weights::check(image.data(), static_cast<std::uint32_t>(4 * image.size()), weights);
  if (status != satp::WeightStatus::kOk) {
    throw std::runtime_error(std::string("the image is refused: ") + satp::weight_status_name(status));
  }
  Forecasts result(samples.size());
  const auto scratch = std::make_unique<satp::EncoderScratch>();
  const auto work = std::make_unique<satp::DecoderScratch>();
  const auto encoded = std::make_unique<satp::Encoded>();
  satp::Futures futures;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Sample& sample = set[samples[i]];
    const bool shown = with_plan && (sample.flags & kNoPlan) == 0;
    satp::encode(weights, sample.input, *scratch, *encoded);
    for (int vehicle = 0; vehicle < sample.input.hdvs; ++vehicle) {
      satp::decode(weights, *encoded, vehicle, shown ? sample.plan.step[vehicle] : nullptr, *work, futures);
      Forecast& forecast = result[i][static_cast<std::size_t>(vehicle)];
      forecast.gate = static_cast<float>(encoded->gate[vehicle]) / 32768.0F;
      for (int mode = 0; mode < kMaxModes; ++mode) {
        forecast.probability[mode] = futures.probability[mode];
        forecast.yields[mode] = futures.yields[mode];
        for (int step = 0; step < kHorizonSteps; ++step) {
          forecast.position_m[mode][step][0] = futures.poses[mode][step].x_m;
          forecast.position_m[mode][step][1] = futures.poses[mode][step].y_m;
        }
      }
    }
  }
  return result;
}

}  // namespace s4tp::train
