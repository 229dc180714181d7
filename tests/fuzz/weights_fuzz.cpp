// A weight image in flash, changed here and there, its checksums made to fit again or not: refused with a reason, or a
// network that computes whatever it is told, without an accumulator running over (UBSan sees it).

#include <algorithm>
#include <limits>
#include <memory>
#include <vector>

#include "algo/core/crc32.hpp"
#include "algo/satp/decoder.hpp"
#include "algo/satp/encoder.hpp"
#include "algo/satp/weight_image.hpp"
#include "tests/fuzz/input.hpp"
#include "tests/support/random_network.hpp"

using namespace s4tp;
using fuzz::expect;
using fuzz::Input;

namespace {

using Words = std::vector<std::int32_t>;

struct Scratch {
  satp::NetworkInput input;
  satp::PlanInput plan;
  satp::EncoderScratch encoder;
  satp::Encoded encoded;
  satp::DecoderScratch decoder;
  satp::Futures futures;
};

void compute(const satp::Weights& weights, std::uint64_t seed) {
  static const auto scratch = std::make_unique<Scratch>();
  test::make_random_input(seed, 2, scratch->input);
  test::make_random_plan(seed, 2, scratch->plan);
  satp::encode(weights, scratch->input, scratch->encoder, scratch->encoded);
  satp::decode(weights, scratch->encoded, 0, scratch->plan.step[0], scratch->decoder, scratch->futures);
  for (const float probability : scratch->futures.probability) {
    expect(probability >= 0.0F && probability <= 1.001F, "a probability is one");
  }
}

/// A word as an attacker of accumulators would choose it.
std::int32_t take_word(Input& input, std::int32_t old) {
  constexpr std::int32_t kExtremes[] = {0,
                                        -1,
                                        0x7F7F7F7F,
                                        0x01010101,
                                        static_cast<std::int32_t>(0x80808080),
                                        std::numeric_limits<std::int32_t>::max(),
                                        std::numeric_limits<std::int32_t>::min()};
  const int how = input.below(16);
  if (how < 7) return kExtremes[how];
  if (how < 11)
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(old) ^ (1U << (input.byte() % 32U)));
  return input.take<std::int32_t>();
}

/// A word of the payload: near a layer's begin, where its biases are, or anywhere.
std::size_t take_place(Input& input) {
  const int layer = input.below(satp::kLayerCount + 16);
  if (layer >= satp::kLayerCount)
    return input.take<std::uint32_t>() % (satp::payload_bytes(satp::kMcuShape) / 4);
  return static_cast<std::size_t>(satp::layer_offset(satp::kMcuShape, layer)) / 4 + input.byte();
}

/// Checksums that fit whatever stands in the header, a wrong length too.
void seal(Words& words) {
  auto& header = *reinterpret_cast<satp::WeightHeader*>(words.data());
  const std::uint32_t said = header.payload_bytes;
  header.payload_bytes = satp::kImageBytes - sizeof(satp::WeightHeader);
  satp::seal(words.data());
  header.payload_bytes = said;
  header.header_crc = crc32(&header, sizeof header - sizeof header.header_crc);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t kWords = satp::kImageBytes / 4;
  constexpr std::size_t kHeaderWords = sizeof(satp::WeightHeader) / 4;
  static const Words good = [] {
    Words words(kWords);
    test::make_random_image(1, words.data());
    return words;
  }();
  Input input(data, size);
  Words words = good;
  const int how = input.byte();
  while (!input.empty()) {
    const bool in_header = input.below(8) == 0;
    const std::size_t at = in_header ? input.byte() % kHeaderWords : kHeaderWords + take_place(input);
    const std::size_t run =
        in_header ? 1 : std::min<std::size_t>(1U + input.byte() % 64U, at < kWords ? kWords - at : 0);
    for (std::size_t i = 0; i < run; ++i) words[at + i] = take_word(input, words[at + i]);
  }
  if (how % 4 != 3) seal(words);
  std::uint32_t bytes = satp::kImageBytes;
  if (how % 16 == 8) bytes = static_cast<std::uint32_t>(how) * 1000U;
  const Words exact(words.begin(),
                    words.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(bytes / 4, kWords)));
  satp::Weights weights;
  bytes = static_cast<std::uint32_t>(4 * exact.size());
  const satp::WeightStatus status = satp::Weights::check(how == 0 ? nullptr : exact.data(), bytes, weights);
  expect(weights.present() == (status == satp::WeightStatus::kOk),
         "weights are there when they pass, only then");
  expect(*satp::weight_status_name(status) != '\0', "a status has a name");
  if (status == satp::WeightStatus::kOk && how % 4 == 1) compute(weights, static_cast<std::uint64_t>(how));
  return 0;
}
