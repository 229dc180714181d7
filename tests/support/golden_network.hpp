#pragma once
/// The golden vector of the network: what a random image predicts of random scenes, as one number (SATP-030).

#include <cstdint>

#include "algo/satp/decoder.hpp"
#include "tests/support/random_network.hpp"

namespace s4tp::test {

inline constexpr std::uint64_t kGoldenSeed = 20261122;
inline constexpr int kGoldenScenes = 6;  ///< with 0 .. 5 vehicles
inline constexpr std::uint32_t kGoldenNetwork = 0x0A6208A6U;

/// Hash of everything the network says of the golden scenes, with and without plan.
inline std::uint32_t golden_network(const satp::Weights& weights, satp::NetworkInput& input,
                                    satp::PlanInput& plan, satp::EncoderScratch& scratch,
                                    satp::Encoded& encoded, satp::DecoderScratch& decoding,
                                    satp::Futures& futures) {
  std::uint32_t value = 2166136261U;
  for (int scene = 0; scene < kGoldenScenes; ++scene) {
    const int hdvs = scene % (kMaxAgents + 1);
    make_random_input(kGoldenSeed + 1 + static_cast<std::uint64_t>(scene), hdvs, input);
    make_random_plan(kGoldenSeed + 100 + static_cast<std::uint64_t>(scene), hdvs, plan);
    encode(weights, input, scratch, encoded);
    for (int i = 0; i < hdvs; ++i) {
      value = hash_bytes(encoded.start[i], sizeof encoded.start[i], value);
      value = hash_bytes(&encoded.gate[i], sizeof encoded.gate[i], value);
      for (int planned = 0; planned < 2; ++planned) {
        decode(weights, encoded, i, planned == 1 ? plan.step[i] : nullptr, decoding, futures);
        value = hash_bytes(futures.probability, sizeof futures.probability, value);
        value = hash_bytes(futures.yields, sizeof futures.yields, value);
        value = hash_bytes(futures.poses, sizeof futures.poses, value);
      }
    }
  }
  return value;
}

}  // namespace s4tp::test
