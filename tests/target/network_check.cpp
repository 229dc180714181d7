/// The network alone, with random weights: the bits of what it predicts, fast kernels against the plain
/// reference, and what it costs in SysTick counts. Exit code: 0 the bits are the golden ones and the kernels
/// agree, 1 they are not.

#include <cstring>

#include "algo/satp/kernels.hpp"
#include "firmware/targets/platform.hpp"
#include "firmware/targets/text.hpp"
#include "tests/support/golden_network.hpp"

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
std::int32_t fast[satp::kMaxBatch][satp::kMaxRows];
std::int32_t plain[satp::kMaxBatch][satp::kMaxRows];

/// Counts of one call of a kernel on a layer of that size; < 0 when its bits are not the reference's.
template <typename In>
std::int32_t try_kernel(std::int32_t rows, std::int32_t columns, std::int32_t batch, const In* inputs) {
  const satp::Linear layer{weights8,
                           biases,
                           biases,
                           static_cast<std::int16_t>(rows),
                           static_cast<std::int16_t>(columns),
                           static_cast<std::int16_t>((columns + 3) / 4 * 4)};
  std::memset(fast, 0, sizeof fast);
  std::memset(plain, 0, sizeof plain);
  satp::reference::multiply(layer, biases, kMost, inputs, kMost, batch, plain);
  const std::uint32_t began = counts_now();
  satp::multiply(layer, biases, kMost, inputs, kMost, batch, fast);
  const std::uint32_t ended = counts_now();
  for (int b = 0; b < batch; ++b) {
    if (std::memcmp(fast[b], plain[b], sizeof(std::int32_t) * static_cast<unsigned>(rows)) != 0) return -1;
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
  const bool agree = kernels_agree();
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
