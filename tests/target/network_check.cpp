/// The network alone, with random weights: the bits of what it predicts, fast kernels and elementwise
/// arithmetic against their plain words (SATP-020, SATP-027), and what it costs in SysTick counts. Exit code: 0 the bits are the golden ones and the kernels
/// agree, 1 they are not.

#include <cstring>

#include "algo/satp/kernels.hpp"
#include "algo/satp/linear.hpp"
#include "firmware/targets/platform.hpp"
#include "firmware/targets/text.hpp"
#include "tests/support/golden_network.hpp"
#include "tests/support/lane_agreement.hpp"

namespace s4tp::targets {
namespace {

// Made here, where a linked image lies: on the emulated boards flash is plain memory, and the RAM's share is
// too small.
[[gnu::section(".weights.random")]] alignas(8) std::int32_t image[satp::kImageBytes / 4] = {1};
satp::NetworkInput input;
satp::PlanInput plan;
satp::EncoderScratch scratch;
satp::Encoded encoded;
satp::DecoderScratch decoding;
satp::Futures futures;

constexpr int kMost = 128;
alignas(8) std::int8_t weights8[kMost * kMost];
alignas(8) std::int8_t inputs8[satp::kMaxBatch * kMost];
alignas(8) std::int16_t inputs16[satp::kMaxBatch * kMost];
std::int32_t biases[satp::kMaxBatch * kMost];
std::int32_t multipliers[kMost];
alignas(8) std::int8_t outputs8[satp::kMaxBatch * kMost];
alignas(8) std::int16_t outputs16[satp::kMaxBatch * kMost];
std::int32_t fast[satp::kMaxBatch][satp::kMaxRows];
std::int32_t plain[satp::kMaxBatch][satp::kMaxRows];
test::LaneAgreement lanes;

/// The rounding rule in plain words, and the ends of a type's range.
std::int32_t rescaled(std::int32_t sum, std::int32_t multiplier, int shift, std::int32_t low,
                      std::int32_t high) {
  const std::int64_t product = static_cast<std::int64_t>(sum) * multiplier;
  const std::int64_t q = (product + (std::int64_t{1} << (shift - 1))) >> shift;
  return static_cast<std::int32_t>(q < low ? low : (q > high ? high : q));
}

/// Whether `outputs` is what the plain sums become. \param offset  of the type's values: 128 behind a ReLU
template <typename In, typename Out>
bool outputs_agree(const satp::Linear& layer, std::int32_t batch, const Out* outputs, std::int32_t low,
                   std::int32_t high, std::int32_t offset) {
  constexpr int kShift = sizeof(In) == 1 ? 24 : 32;
  for (int b = 0; b < batch; ++b) {
    for (int o = 0; o < layer.rows; ++o) {
      if (outputs[b * kMost + o] + offset != rescaled(plain[b][o], layer.multiplier[o], kShift, low, high))
        return false;
    }
  }
  return true;
}

/// Counts of one call of a layer of that size, rescaling included; < 0 when a kernel's bits are not the
/// reference's or an output is not what they become.
template <typename In>
std::int32_t try_kernel(std::int32_t rows, std::int32_t columns, std::int32_t batch, const In* inputs) {
  const satp::Linear layer{weights8,
                           biases,
                           multipliers,
                           static_cast<std::int16_t>(rows),
                           static_cast<std::int16_t>(columns),
                           static_cast<std::int16_t>((columns + 3) / 4 * 4)};
  std::memset(fast, 0, sizeof fast);
  std::memset(plain, 0, sizeof plain);
  satp::reference::multiply(layer, biases, kMost, inputs, kMost, batch, plain);
  satp::multiply(layer, biases, kMost, inputs, kMost, batch, fast);
  for (int b = 0; b < batch; ++b) {
    if (std::memcmp(fast[b], plain[b], sizeof(std::int32_t) * static_cast<unsigned>(rows)) != 0) return -1;
  }

  const satp::Rows<const In> from{inputs, kMost};
  const satp::Rows<std::int8_t> to8{outputs8, kMost};
  const satp::Rows<std::int16_t> to16{outputs16, kMost};
  satp::reference::multiply(layer, biases, 0, inputs, kMost, batch, plain);
  const std::uint32_t began = counts_now();
  linear(layer, from, batch, to16);
  const std::uint32_t ended = counts_now();
  if (!outputs_agree<In>(layer, batch, outputs16, -32768, 32767, 0)) return -1;
  linear_relu(layer, from, batch, to8);
  if (!outputs_agree<In>(layer, batch, outputs8, 0, 255, 128)) return -1;
  if constexpr (sizeof(In) == 1) {
    linear(layer, from, batch, to8);
    if (!outputs_agree<In>(layer, batch, outputs8, -128, 127, 0)) return -1;
    satp::reference::multiply(layer, biases, rows, inputs, kMost, batch, plain);
    linear_by_row(layer, from, batch, to8);
    if (!outputs_agree<In>(layer, batch, outputs8, -128, 127, 0)) return -1;
  } else {
    linear_relu(layer, from, batch, to16);
    if (!outputs_agree<In>(layer, batch, outputs16, 0, 32767, 0)) return -1;
  }
  return static_cast<std::int32_t>(ended - began);
}

bool kernels_agree() {
  struct Size {
    std::int32_t rows, columns;
  };
  constexpr Size kSizes[] = {{32, 32},  {64, 64}, {64, 80}, {48, 48}, {48, 32},
                             {32, 128}, {48, 96}, {1, 32},  {5, 16}};
  constexpr Size kWideSizes[] = {{32, 5}, {32, 8}, {32, 12}, {32, 32}, {15, 48}, {1, 96}, {3, 7}};
  test::Random random(7);
  bool agree = true;
  const auto report = [&agree](const char* kind, const Size& size, std::int32_t batch, std::int32_t counts) {
    Text line;
    line << "kernel " << kind << " " << size.rows << " x " << size.columns << " batch " << batch
         << ": counts " << counts << ", multiply-adds " << size.rows * size.columns * batch << "\n";
    if (counts < 0 || batch != 2) print(line.c_str());
    agree = agree && counts >= 0;
  };
  for (int round = 0; round < 3; ++round) {
    for (std::int8_t& weight : weights8)
      weight = static_cast<std::int8_t>(round == 0 ? (random.integer(0, 1) != 0 ? 127 : -127)
                                                   : random.integer(-127, 127));
    for (std::int8_t& value : inputs8)
      value = static_cast<std::int8_t>(round == 0 ? -128 : random.integer(-128, 127));
    for (std::int16_t& value : inputs16)
      value = static_cast<std::int16_t>(round == 0 ? -32768 : random.integer(-32768, 32767));
    for (std::int32_t& bias : biases) bias = random.integer(-1000000, 1000000);
    for (std::int32_t& multiplier : multipliers)
      multiplier = static_cast<std::int32_t>(random.next() >> static_cast<unsigned>(random.integer(1, 24)));
    for (std::int32_t batch = 1; batch <= satp::kMaxBatch; ++batch) {
      for (const Size& size : kSizes) {
        const std::int32_t counts = try_kernel(size.rows, size.columns, batch, inputs8);
        if (round == 2 || counts < 0) report("int8", size, batch, counts);
      }
      for (const Size& size : kWideSizes) {
        // Rows of weights end in zeros.
        const int stride = (size.columns + 3) / 4 * 4;
        for (int o = 0; o < size.rows; ++o) {
          for (int j = size.columns; j < stride; ++j) weights8[o * stride + j] = 0;
        }
        const std::int32_t counts = try_kernel(size.rows, size.columns, batch, inputs16);
        if (round == 2 || counts < 0) report("int16", size, batch, counts);
      }
    }
  }
  return agree;
}

bool lanes_agree() {
  constexpr int kRounds = 300;
  const char* different = lanes.first_difference(test::kGoldenSeed, kRounds);
  if (different == nullptr) return true;
  print("elementwise arithmetic is not what its plain words say: ");
  print(different);
  print("\n");
  return false;
}

void print_cost(const satp::Weights& weights) {
  test::make_random_input(test::kGoldenSeed, kMaxAgents, input);
  test::make_random_plan(test::kGoldenSeed, kMaxAgents, plan);
  for (auto& points : input.lane_points) {
    for (std::uint8_t& count : points) count = satp::kLanePoints;
  }
  const std::uint32_t began = counts_now();
  encode(weights, input, scratch, encoded);
  const std::uint32_t between = counts_now();
  for (int i = 0; i < kMaxAgents; ++i) decode(weights, encoded, i, plan.step[i], decoding, futures);
  const std::uint32_t ended = counts_now();
  Text line;
  line << "network counts: encode " << between - began << ", a decode " << ended - between << ", stack "
       << stack_used() << "\n";
  print(line.c_str());
}

}  // namespace

int run(const char*, bool) {
  start_counting();
  const bool agree = kernels_agree() && lanes_agree();
  test::make_random_image(test::kGoldenSeed, image);
  satp::Weights weights;
  const satp::WeightStatus status = satp::Weights::check(image, sizeof image, weights);
  if (status != satp::WeightStatus::kOk) {
    print(satp::weight_status_name(status));
    print(": the random image is refused\n");
    return 1;
  }
  const std::uint32_t bits = test::golden_network(weights, input, plan, scratch, encoded, decoding, futures);
  print_cost(weights);
  Text line;
  line << "network bits ";
  line.hex(bits, 8) << (agree ? ", kernels agree" : ", kernels DISAGREE") << "\n";
  print(line.c_str());
  return agree && bits == test::kGoldenNetwork ? 0 : 1;
}

}  // namespace s4tp::targets
