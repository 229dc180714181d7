// What of a weight image is accepted, and what each harm is called.

#include "algo/satp/weight_image.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <limits>
#include <vector>

#include "algo/core/crc32.hpp"
#include "tests/support/random_network.hpp"

namespace s4tp::satp {
namespace {

using Words = std::vector<std::int32_t>;

Words image_of(std::uint64_t seed = 1) {
  Words words(kImageBytes / 4);
  test::make_random_image(seed, words.data());
  return words;
}

WeightStatus judge(const Words& words, std::uint32_t size_bytes = kImageBytes) {
  Weights weights;
  const WeightStatus status = Weights::check(words.data(), size_bytes, weights);
  EXPECT_EQ(weights.present(), status == WeightStatus::kOk);
  return status;
}

/// The status after `harm`, with checksums that fit again: a fault of whoever wrote it.
WeightStatus judge_resealed(const std::function<void(WeightHeader&, std::int32_t*)>& harm) {
  Words words = image_of();
  harm(*reinterpret_cast<WeightHeader*>(words.data()), words.data() + sizeof(WeightHeader) / 4);
  seal(words.data());
  return judge(words);
}

// SATP-010 A sealed image passes, longer flash behind it or not; its layers lie where the table says.
TEST(WeightImage, AcceptsWhatIsWhole) {
  const Words words = image_of();
  EXPECT_EQ(judge(words), WeightStatus::kOk);
  Weights weights;
  ASSERT_EQ(Weights::check(words.data(), kImageBytes + 1000, weights), WeightStatus::kOk);
  const auto* payload = reinterpret_cast<const char*>(words.data()) + sizeof(WeightHeader);
  EXPECT_EQ(reinterpret_cast<const char*>(weights.linear(kGruGates).bias),
            payload + layer_offset(kMcuShape, kGruGates));
  EXPECT_EQ(weights.linear(kGruGates).rows, 96);
  EXPECT_EQ(weights.linear(kEgoEmbed1).stride, 8);
}

// SATP-010 Nothing, a piece, something else, another version or size of network.
TEST(WeightImage, RefusesWithTheReason) {
  Weights weights;
  EXPECT_EQ(Weights::check(nullptr, 0, weights), WeightStatus::kAbsent);
  const Words words = image_of();
  EXPECT_EQ(judge(words, 40), WeightStatus::kTruncated);
  EXPECT_EQ(judge(words, kImageBytes - 1), WeightStatus::kTruncated);
  EXPECT_EQ(Weights::check(reinterpret_cast<const char*>(words.data()) + 1, kImageBytes, weights),
            WeightStatus::kNotWeights);
  EXPECT_EQ(judge(Words(kImageBytes / 4, -1)), WeightStatus::kNotWeights);  // erased flash
  const auto header_harm = [](auto field, auto value) {
    return judge_resealed([=](WeightHeader& header, std::int32_t*) { header.*field = value; });
  };
  EXPECT_EQ(header_harm(&WeightHeader::magic, 0U), WeightStatus::kNotWeights);
  EXPECT_EQ(header_harm(&WeightHeader::format, kWeightFormat + 1), WeightStatus::kFormat);
  EXPECT_EQ(header_harm(&WeightHeader::shape_id, std::uint32_t{kTeacherShape.id}), WeightStatus::kShape);
  EXPECT_EQ(header_harm(&WeightHeader::hidden, 64U), WeightStatus::kShape);
  EXPECT_EQ(header_harm(&WeightHeader::temperature, 0.0F), WeightStatus::kRange);
  EXPECT_EQ(header_harm(&WeightHeader::temperature, std::numeric_limits<float>::quiet_NaN()),
            WeightStatus::kRange);
}

// SATP-010 One bit anywhere: every 97th word is tried, and each of the header's.
TEST(WeightImage, SeesEveryFlippedBit) {
  Words words = image_of();
  for (std::size_t i = 0; i < words.size(); i += i < sizeof(WeightHeader) / 4 ? 1 : 97) {
    words[i] ^= 1 << (i % 31);
    EXPECT_NE(judge(words), WeightStatus::kOk) << "word " << i;
    words[i] ^= 1 << (i % 31);
  }
}

// SATP-011 Checksums right, numbers wrong: -128, a filler that is not 0, a bias or multiplier beyond its
// range, a scale that is not a number.
TEST(WeightImage, RefusesNumbersThatCouldRunOver) {
  const auto at = [](int layer) { return layer_offset(kMcuShape, layer) / 4; };
  const auto harm = [](int word, std::int32_t value) {
    return judge_resealed([=](WeightHeader&, std::int32_t* payload) { payload[word] = value; });
  };
  EXPECT_EQ(harm(at(kGruGates) + 2 * 96, -128), WeightStatus::kRange);             // bytes 80 FF FF FF
  EXPECT_EQ(harm(at(kEgoEmbed1) + 2 * 32 + 1, 0x01010101), WeightStatus::kRange);  // columns 5 to 7 of a row
  EXPECT_EQ(harm(at(kGruGates), 1 << 23), WeightStatus::kRange);
  EXPECT_EQ(harm(at(kGruGates) + 96, -1), WeightStatus::kRange);
  EXPECT_EQ(harm(at(kIncrements) + 15, 0x7FC00000), WeightStatus::kRange);
  EXPECT_EQ(harm(at(kNullPlan), 32768), WeightStatus::kRange);
  EXPECT_EQ(harm(at(kAgent1 + kNorm1) + 32, 40000), WeightStatus::kRange);
  EXPECT_EQ(harm(at(kAgent1 + kAdd1), -5), WeightStatus::kRange);
}

// CORE-021 The check value of CRC-32/ISO-HDLC.
TEST(Crc32, GivesTheCheckValue) {
  EXPECT_EQ(crc32("123456789", 9), 0xCBF43926U);
}

}  // namespace
}  // namespace s4tp::satp
