// The C facade beside the planner: parameters, map, names, sampling.

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <string>

#include "algo/api/s4tp.h"
#include "algo/core/versions.hpp"
#include "algo/planner/planner.hpp"
#include "tests/support/c_facade.hpp"
#include "tests/support/c_map.hpp"

namespace s4tp {
namespace {

// API-010: a block one byte off its alignment is refused, not written to.
TEST(CFacadeBlock, MisalignedBlockIsRefused) {
  const auto bytes = std::make_unique<unsigned char[]>(sizeof(s4tp_block) + 8);
  EXPECT_EQ(s4tp_init(reinterpret_cast<s4tp_block*>(bytes.get() + 1), nullptr, nullptr),
            S4TP_INVALID_ARGUMENT);
}

// API-003, API-004, API-005: the table by name; a value outside its range changes nothing.
TEST(CFacadeParameters, ByName) {
  s4tp_parameters parameters;
  ASSERT_EQ(s4tp_default_parameters(&parameters), S4TP_OK);
  ASSERT_EQ(s4tp_parameter_count(), kParameterCount);
  for (int i = 0; i < kParameterCount; ++i) {
    s4tp_parameter_info row;
    ASSERT_EQ(s4tp_describe_parameter(i, &row), S4TP_OK);
    float value = -1.0F;
    EXPECT_EQ(s4tp_get_parameter(&parameters, row.name, &value), S4TP_OK);
    EXPECT_EQ(value, row.initial);
    EXPECT_EQ(s4tp_set_parameter(&parameters, row.name, row.maximum), S4TP_OK);
    EXPECT_EQ(s4tp_set_parameter(&parameters, row.name, std::nextafter(row.maximum, 1e30F)),
              S4TP_INVALID_PARAMETER);
    EXPECT_EQ(s4tp_set_parameter(&parameters, row.name, row.minimum - 1.0F), S4TP_INVALID_PARAMETER);
    EXPECT_EQ(s4tp_set_parameter(&parameters, row.name, test::kNaN), S4TP_INVALID_PARAMETER);
    EXPECT_EQ(s4tp_get_parameter(&parameters, row.name, &value), S4TP_OK);
    EXPECT_EQ(value, row.maximum);
  }
  s4tp_parameter_info row;
  float value = 0.0F;
  EXPECT_EQ(s4tp_describe_parameter(kParameterCount, &row), S4TP_INVALID_ARGUMENT);
  EXPECT_EQ(s4tp_describe_parameter(-1, &row), S4TP_INVALID_ARGUMENT);
  EXPECT_EQ(s4tp_describe_parameter(0, nullptr), S4TP_INVALID_ARGUMENT);
  EXPECT_EQ(s4tp_set_parameter(&parameters, "vehicle.wings", 2.0F), S4TP_INVALID_ARGUMENT);
  EXPECT_EQ(s4tp_set_parameter(&parameters, nullptr, 2.0F), S4TP_INVALID_ARGUMENT);
  EXPECT_EQ(s4tp_get_parameter(&parameters, "vehicle.wings", &value), S4TP_INVALID_ARGUMENT);
  EXPECT_EQ(s4tp_get_parameter(nullptr, "vehicle.width_m", &value), S4TP_INVALID_ARGUMENT);
  EXPECT_EQ(s4tp_default_parameters(nullptr), S4TP_INVALID_ARGUMENT);
}

// API-006: the core's own number, and another one for another value.
TEST(CFacadeParameters, CrcIsTheCores) {
  s4tp_parameters parameters;
  ASSERT_EQ(s4tp_default_parameters(&parameters), S4TP_OK);
  const std::uint32_t usual = s4tp_parameters_crc(&parameters);
  EXPECT_EQ(usual, parameters_crc(Parameters{}));
  ASSERT_EQ(s4tp_set_parameter(&parameters, "comfort.headway_s", 1.5F), S4TP_OK);
  EXPECT_NE(s4tp_parameters_crc(&parameters), usual);
  EXPECT_EQ(s4tp_parameters_crc(nullptr), 0U);
}

// API-007: no lane is linked to another, none has a stop line.
TEST(CFacadeMap, ClearedMapLinksNothing) {
  s4tp_lane_map map;
  std::memset(&map, 1, sizeof(map));
  ASSERT_EQ(s4tp_clear_map(&map), S4TP_OK);
  EXPECT_EQ(map.conflict_count, 0);
  for (const s4tp_lane& lane : map.lanes) {
    EXPECT_EQ(lane.present, 0);
    EXPECT_EQ(lane.left, S4TP_NO_LANE_INDEX);
    EXPECT_EQ(lane.right, S4TP_NO_LANE_INDEX);
    for (const std::int8_t successor : lane.successors) EXPECT_EQ(successor, S4TP_NO_LANE_INDEX);
    EXPECT_LT(lane.stop_line_m, 0.0F);
  }
  EXPECT_EQ(s4tp_clear_map(nullptr), S4TP_INVALID_ARGUMENT);
}

// API-001, API-002: every answer has a name of its own; the versions are the build's.
TEST(CFacadeNames, StatusAndVersions) {
  EXPECT_STREQ(s4tp_status_name(S4TP_OK), "S4TP_OK");
  for (s4tp_status a = S4TP_OK; a <= S4TP_INVALID_ARGUMENT; ++a) {
    EXPECT_EQ(std::string(s4tp_status_name(a)).substr(0, 5), "S4TP_");
    for (s4tp_status b = S4TP_OK; b < a; ++b) EXPECT_STRNE(s4tp_status_name(a), s4tp_status_name(b));
  }
  EXPECT_STREQ(s4tp_status_name(-1), "unknown status");
  EXPECT_STREQ(s4tp_status_name(9), "unknown status");
  EXPECT_EQ(s4tp_get_versions().api, S4TP_API_VERSION);
  EXPECT_EQ(s4tp_get_versions().wire, kWireVersion);
}

// API-014: 8 m/s to 10 m/s over the second step is 9 m/s at 150 ms; held before the start and after the end.
TEST(CFacadeSample, InterpolatesAndHolds) {
  s4tp_plan plan = {};
  plan.kind = S4TP_PLAN_DRIVE;
  plan.start_ms = 5000;
  plan.points[1].speed_mps = 8.0F;
  plan.points[2].speed_mps = 10.0F;
  plan.points[30].speed_mps = 3.0F;
  s4tp_plan_point point;
  ASSERT_EQ(s4tp_sample(&plan, 5150, &point), S4TP_OK);
  EXPECT_FLOAT_EQ(point.speed_mps, 9.0F);
  ASSERT_EQ(s4tp_sample(&plan, 4000, &point), S4TP_OK);
  EXPECT_EQ(point.speed_mps, 0.0F);
  ASSERT_EQ(s4tp_sample(&plan, 9000, &point), S4TP_OK);
  EXPECT_EQ(point.speed_mps, 3.0F);
  EXPECT_EQ(s4tp_sample(nullptr, 0, &point), S4TP_INVALID_ARGUMENT);
  EXPECT_EQ(s4tp_sample(&plan, 0, nullptr), S4TP_INVALID_ARGUMENT);
  plan.points[1].heading_rad = 1e30F;
  EXPECT_EQ(s4tp_sample(&plan, 5050, &point), S4TP_INVALID_ARGUMENT) << "no angle of ours";
  plan.points[1].heading_rad = 0.0F;
  plan.kind = 9;
  EXPECT_EQ(s4tp_sample(&plan, 0, &point), S4TP_INVALID_ARGUMENT);
}

}  // namespace
}  // namespace s4tp
