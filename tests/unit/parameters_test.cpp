#include "algo/core/parameters.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "algo/core/parameter_info.hpp"
#include "algo/core/versions.hpp"

namespace s4tp {
namespace {

const std::string kDocument = std::string(S4TP_SOURCE_DIR) + "/docs/parameters.md";

std::string number(float value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

/// docs/parameters.md as the table has it.
std::string document() {
  std::ostringstream text;
  text << "# Parameters\n\n"
       << "Every run-time value of the core, version " << int{kParametersVersion}
       << ". Made from `algo/core/parameters.def`; do not edit.\n"
       << "In TOML: `[group]`, then `field = value`.\n";
  std::string group;
  for (int i = 0; i < kParameterCount; ++i) {
    const ParameterInfo& info = parameter_info(i);
    const std::string name = info.name;
    const std::string its_group = name.substr(0, name.find('.'));
    if (its_group != group) {
      group = its_group;
      text << "\n## " << group
           << "\n\n| field | unit | default | minimum | maximum | meaning |\n|---|---|---|---|---|---|\n";
    }
    text << "| " << name.substr(name.find('.') + 1) << " | " << info.unit << " | " << number(info.initial)
         << " | " << number(info.minimum) << " | " << number(info.maximum) << " | " << info.meaning << " |\n";
  }
  return text.str();
}

}  // namespace

// CORE-020: the defaults are valid.
TEST(Parameters, DefaultsAreValid) {
  int first_bad = -1;
  EXPECT_EQ(validate(Parameters{}, first_bad), Status::kOk);
}

// CORE-003 CORE-020: every field alone, just outside its range or not a number, is named; the first one wins.
TEST(Parameters, ValidateNamesTheFirstBadField) {
  for (int i = 0; i < kParameterCount; ++i) {
    const ParameterInfo& info = parameter_info(i);
    const float below = std::nextafter(info.minimum, -1e30F);
    const float above = std::nextafter(info.maximum, 1e30F);
    for (const float bad :
         {below, above, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
      Parameters parameters;
      set_parameter(parameters, i, bad);
      set_parameter(parameters, kParameterCount - 1, bad);
      int first_bad = -1;
      EXPECT_EQ(validate(parameters, first_bad), Status::kInvalidParameter) << info.name;
      EXPECT_EQ(first_bad, i) << info.name;
    }
  }
}

// CORE-020: both ends of every range belong to it.
TEST(Parameters, RangesIncludeTheirEnds) {
  Parameters low;
  Parameters high;
  for (int i = 0; i < kParameterCount; ++i) {
    set_parameter(low, i, parameter_info(i).minimum);
    set_parameter(high, i, parameter_info(i).maximum);
  }
  int first_bad = -1;
  EXPECT_EQ(validate(low, first_bad), Status::kOk);
  EXPECT_EQ(validate(high, first_bad), Status::kOk);
}

// The index is the field's place in the struct, and its name finds it again.
TEST(Parameters, NamesAndIndicesAgree) {
  Parameters parameters;
  parameters.risk.look_ahead_s = 2.25F;
  EXPECT_EQ(get_parameter(parameters, find_parameter("risk.look_ahead_s")), 2.25F);
  std::set<std::string> names;
  for (int i = 0; i < kParameterCount; ++i) {
    EXPECT_EQ(find_parameter(parameter_info(i).name), i);
    EXPECT_EQ(get_parameter(Parameters{}, i), parameter_info(i).initial);
    names.insert(parameter_info(i).name);
  }
  EXPECT_EQ(names.size(), static_cast<std::size_t>(kParameterCount));
  EXPECT_EQ(find_parameter("risk.no_such_field"), -1);
}

// CORE-021: the CRC is that of IEEE 802.3 over the version and the floats, computed here by its definition as
// a polynomial division of the reflected bytes.
TEST(Parameters, CrcIsTheStandardOne) {
  std::vector<std::uint8_t> bytes = {kParametersVersion};
  for (int i = 0; i < kParameterCount; ++i) {
    const float value = get_parameter(Parameters{}, i);
    std::uint8_t raw[4];
    std::memcpy(raw, &value, 4);
    bytes.insert(bytes.end(), raw, raw + 4);
  }
  std::uint32_t remainder = 0xFFFFFFFFU;
  for (const std::uint8_t byte : bytes) {
    for (unsigned bit = 0; bit < 8; ++bit) {
      const bool feedback = ((remainder ^ (static_cast<std::uint32_t>(byte) >> bit)) & 1U) != 0;
      remainder >>= 1;
      if (feedback) remainder ^= 0xEDB88320U;
    }
  }
  EXPECT_EQ(parameters_crc(Parameters{}), ~remainder);
}

// CORE-021: every field counts.
TEST(Parameters, CrcSeesEveryField) {
  const std::uint32_t before = parameters_crc(Parameters{});
  for (int i = 0; i < kParameterCount; ++i) {
    Parameters parameters;
    set_parameter(parameters, i, get_parameter(parameters, i) + 0.125F);
    EXPECT_NE(parameters_crc(parameters), before) << parameter_info(i).name;
  }
}

// docs/parameters.md says what the table says. S4TP_REGENERATE=1 writes it anew.
TEST(Parameters, DocumentationIsUpToDate) {
  if (std::getenv("S4TP_REGENERATE") != nullptr) std::ofstream(kDocument) << document();
  std::ifstream file(kDocument);
  std::stringstream committed;
  committed << file.rdbuf();
  EXPECT_EQ(committed.str(), document())
      << "regenerate with: S4TP_REGENERATE=1 " << S4TP_BINARY_DIR
      << "/tests/unit_tests --gtest_filter=Parameters.DocumentationIsUpToDate";
}

}  // namespace s4tp
