// The C facade, called as documented or not: a documented answer, and a plan that a vehicle can drive from where the ego is.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include "algo/api/s4tp.h"
#include "tests/fuzz/facade_map.hpp"
#include "tests/fuzz/input.hpp"
#include "tests/support/plan_oracles.hpp"

using namespace s4tp;
using fuzz::expect;
using fuzz::Input;

void s4tp_on_assertion(const char* expression, const char* file, int line) {
  std::fprintf(stderr, "fuzz: %s:%d: assertion: %s\n", file, line, expression);
  std::abort();
}

namespace {

constexpr float kPi = 3.14159274F;
constexpr float kRounding = 1e-3F;

bool within(float value, float low, float high) {
  return value >= low && value <= high;
}

/// What the header says of an ego state, a list and a point of a plan.
bool documented(const s4tp_ego& ego) {
  return std::abs(ego.x_m) < 100'000.0F && std::abs(ego.y_m) < 100'000.0F &&
         within(ego.heading_rad, -kPi, kPi) && within(ego.speed_mps, 0.0F, 60.0F) &&
         within(ego.acceleration_mps2, -12.0F, 12.0F) && within(ego.yaw_rate_radps, -2.0F, 2.0F) &&
         within(ego.steering_rad, -0.8F, 0.8F);
}

bool documented(const s4tp_tracks& tracks) {
  if (tracks.count < 0 || tracks.count > S4TP_MAX_TRACKS || tracks.left_out < 0) return false;
  return std::all_of(tracks.items, tracks.items + tracks.count, [](const s4tp_track& track) {
    return std::abs(track.x_m) < 100'000.0F && std::abs(track.y_m) < 100'000.0F &&
           within(track.heading_rad, -kPi, kPi) && within(track.speed_mps, 0.0F, 60.0F) &&
           within(track.acceleration_mps2, -12.0F, 12.0F) && within(track.yaw_rate_radps, -1.3F, 1.3F) &&
           within(track.length_m, 0.5F, 25.0F) && within(track.width_m, 0.3F, 3.0F);
  });
}

bool documented(const s4tp_plan_point& point) {
  return std::abs(point.x_m) <= 110'000.0F && std::abs(point.y_m) <= 110'000.0F &&
         within(point.heading_rad, -kPi, kPi) && within(point.speed_mps, 0.0F, 100.0F) &&
         within(point.acceleration_mps2, -13.0F, 13.0F) && within(point.curvature_1pm, -2.0F, 2.0F);
}

/// Parameters as their table allows them, some of them changed; seldom as it does not.
struct Setting {
  s4tp_parameters parameters;
  bool valid = true;

  explicit Setting(Input& input) {
    static_cast<void>(s4tp_default_parameters(&parameters));
    for (int changes = input.byte() % 16 == 1 ? 1 + input.below(6) : 0; changes > 0; --changes) {
      s4tp_parameter_info row;
      const int index = input.below(s4tp_parameter_count());
      expect(s4tp_describe_parameter(index, &row) == S4TP_OK, "a row describes itself");
      const float value = input.below(8) == 7 ? input.take<float>() : input.real(row.minimum, row.maximum);
      const s4tp_status status = s4tp_set_parameter(&parameters, row.name, value);
      const bool good = within(value, row.minimum, row.maximum);
      expect((status == S4TP_OK) == good, "a row takes what is in its range, and nothing else");
      if (!good && input.below(2) == 1) parameters.values[index] = value;
    }
    for (std::int32_t i = 0; i < s4tp_parameter_count(); ++i) {
      s4tp_parameter_info row;
      expect(s4tp_describe_parameter(i, &row) == S4TP_OK, "a row describes itself");
      valid = valid && within(parameters.values[i], row.minimum, row.maximum);
    }
  }
};

/// Onto a lane, along it: elsewhere hardly anybody matters.
void put_on_lane(Input& input, const s4tp_lane_map& map, s4tp_track& track) {
  const s4tp_lane& lane = map.lanes[input.below(20)];
  if (lane.present == 0 || lane.point_count < 2 || lane.point_count > S4TP_MAX_LANE_POINTS) return;
  const int from = input.below(lane.point_count - 1);
  const float along = input.real(0.0F, 1.0F);
  const float dx_m = lane.x_m[from + 1] - lane.x_m[from];
  const float dy_m = lane.y_m[from + 1] - lane.y_m[from];
  track.x_m = lane.x_m[from] + along * dx_m;
  track.y_m = lane.y_m[from] + along * dy_m;
  track.heading_rad = std::atan2(dy_m, dx_m);
  track.acceleration_mps2 = track.yaw_rate_radps = 0.0F;
}

void take_tracks(Input& input, const s4tp_input& world, s4tp_tracks& tracks) {
  const s4tp_ego& ego = world.ego;
  tracks.count = input.below(S4TP_MAX_TRACKS + 1);
  for (std::int32_t i = 0; i < tracks.count; ++i) {
    tracks.items[i] = {static_cast<std::uint8_t>(input.below(24)),
                       std::clamp(ego.x_m, -1e4F, 1e4F) + input.real(-80.0F, 80.0F),
                       std::clamp(ego.y_m, -1e4F, 1e4F) + input.real(-40.0F, 40.0F),
                       input.real(-kPi, kPi),
                       input.real(0.0F, input.below(4) == 0 ? 60.0F : 15.0F),
                       input.real(-12.0F, 12.0F),
                       input.real(-1.3F, 1.3F),
                       input.real(0.5F, 25.0F),
                       input.real(0.3F, 3.0F)};
    if (input.below(4) != 3) put_on_lane(input, *world.map, tracks.items[i]);
    if (input.byte() == 255) tracks.items[i].speed_mps = input.take<float>();
    if (input.byte() == 255) tracks.items[i].heading_rad = input.take<float>();
  }
  if (input.byte() == 255) tracks.count = input.take<std::int32_t>();
}

void take_ego(Input& input, s4tp_ego& ego) {
  ego = {input.real(-80.0F, 80.0F), input.real(-12.0F, 12.0F), input.real(-kPi, kPi),
         input.real(0.0F, 25.0F),   input.real(-12.0F, 12.0F), input.real(-2.0F, 2.0F),
         input.real(-0.8F, 0.8F)};
  float* const numbers[] = {&ego.x_m, &ego.y_m, &ego.heading_rad, &ego.speed_mps, &ego.acceleration_mps2};
  if (input.below(8) == 7) *numbers[input.below(5)] = input.take<float>();
  if (input.below(8) == 7) ego.x_m += input.real(-99'000.0F, 99'000.0F);
}

/// An ego that has kept to its plan; speed, acceleration and wheels as an ego may have them.
s4tp_ego driven_to(const s4tp_plan_point& point, const Setting& setting) {
  float wheelbase_m = 0.0F;
  expect(s4tp_get_parameter(&setting.parameters, "vehicle.wheelbase_m", &wheelbase_m) == S4TP_OK,
         "a row has a value");
  return {point.x_m,
          point.y_m,
          point.heading_rad,
          std::min(point.speed_mps, 60.0F),
          std::clamp(point.acceleration_mps2, -12.0F, 12.0F),
          0.0F,
          std::clamp(std::atan(wheelbase_m * point.curvature_1pm), -0.8F, 0.8F)};
}

/// Where a documented ego goes on, at most so far away after the time up to the start.
void check_start(const s4tp_input& input, const s4tp_plan& plan) {
  const s4tp_plan_point& first = plan.points[0];
  const float lead_s = 0.001F * static_cast<float>(input.start_ms - input.now_ms);
  const bool goes_on = input.running != nullptr;  // the plan in force is gone on from when it is near
  const float way_m = (input.ego.speed_mps + 13.0F * lead_s) * lead_s;
  const float coarse_m = 1e-6F * (std::abs(input.ego.x_m) + std::abs(input.ego.y_m));
  expect(std::hypot(first.x_m - input.ego.x_m, first.y_m - input.ego.y_m) <=
             way_m + coarse_m + (goes_on ? 4.0F : 0.02F),
         "a plan begins where the ego is");
  expect(std::abs(first.speed_mps - input.ego.speed_mps) <=
             13.0F * lead_s + kRounding + (goes_on ? 1.01F : 0.0F),
         "and as fast");
}

/// What a cycle is given beside its input.
struct Given {
  s4tp_plan running;   ///< as it was handed in, or S4TP_PLAN_NONE: the answer may stand in its place
  bool honest = true;  ///< it is as it was written, and so were those that it goes on with
  bool map_sound = true;
};

void check(s4tp_status status, const s4tp_input& input, const Given& given, const s4tp_plan& plan,
           const Setting& setting) {
  const bool known = status == S4TP_OK || status == S4TP_INVALID_INPUT || status == S4TP_NO_LANE ||
                     status == S4TP_NO_SAFE_PLAN || status == S4TP_STALE_TRACKS;
  expect(known && std::strcmp(s4tp_status_name(status), "unknown status") != 0,
         "an answer is a documented one");
  const bool good = documented(input.ego) && (input.tracks == nullptr || documented(*input.tracks)) &&
                    input.start_ms - input.now_ms <= 200U;
  expect(good || status == S4TP_INVALID_INPUT, "what is not as documented is answered so");
  expect(!good || !given.honest || !given.map_sound || status != S4TP_INVALID_INPUT,
         "what is, its own last plan among it, is known for it");
  if (plan.kind == S4TP_PLAN_NONE) {
    s4tp_plan none = {};
    none.start_ms = plan.start_ms;
    expect(status == S4TP_INVALID_INPUT && std::memcmp(&none, &plan, sizeof plan) == 0,
           "no plan is all zeros");
    return;
  }
  expect(plan.start_ms == input.start_ms || status == S4TP_INVALID_INPUT,
         "a plan begins when it was asked for");
  expect(within(plan.fail_safe_branch_s, 0.0F, 3.0F) && within(plan.fail_safe_braking_mps2, 0.0F, 13.0F),
         "the fail-safe is in its range");
  for (const s4tp_plan_point& point : plan.points)
    expect(documented(point), "a plan's numbers are in their ranges");
  const test::PlanOracles oracles(setting.parameters);
  const bool drives = status == S4TP_OK;
  expect(plan.kind == (drives ? S4TP_PLAN_DRIVE : S4TP_PLAN_MINIMUM_RISK),
         "OK is a plan to drive, anything else a minimum-risk manoeuvre");
  const char* broken =
      drives ? oracles.drive(plan, given.honest) : oracles.stop(plan, given.running, given.honest);
  expect(broken == nullptr, broken);
  if (drives || (documented(input.ego) && input.start_ms - input.now_ms <= 200U)) check_start(input, plan);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Input bytes(data, size);
  static const auto block = std::make_unique<s4tp_block>();
  const Setting setting(bytes);
  const char* bad = nullptr;
  const s4tp_status ready = s4tp_init(block.get(), &setting.parameters, &bad);
  expect(setting.valid ? ready == S4TP_OK : ready == S4TP_INVALID_PARAMETER && bad != nullptr,
         "init refuses what is bad");
  static const auto map = std::make_unique<s4tp_lane_map>();
  *map = fuzz::base_map(bytes.byte());
  Given given = {};
  for (int wounds = bytes.below(8) - 4; wounds > 0; --wounds) {
    fuzz::wound(bytes, *map);
    given.map_sound = false;
  }

  s4tp_tracks tracks = {};
  s4tp_plan plan = {};
  s4tp_explanation why = {};
  s4tp_input input = {};
  input.now_ms = bytes.byte() % 16 == 1 ? bytes.take<std::uint32_t>() : 100'000U;
  input.ego = {bytes.real(-60.0F, 20.0F),
               -1.6F + bytes.real(-2.0F, 2.0F),
               0.0F,
               bytes.real(0.0F, 15.0F),
               0.0F,
               0.0F,
               0.0F};
  input.map = map.get();
  input.tracks = &tracks;
  for (int cycle = bytes.below(3); cycle >= 0; --cycle) {
    input.start_ms = input.now_ms + (bytes.byte() % 16 == 1 ? bytes.take<std::uint16_t>() : 100U);
    if (bytes.byte() % 8 == 1) take_ego(bytes, input.ego);
    take_tracks(bytes, input, tracks);
    tracks.time_ms = input.now_ms - (bytes.byte() % 16 == 1 ? bytes.take<std::uint16_t>() : 30U);
    input.degraded = bytes.byte() % 8 == 1 ? 1 : 0;
    given.running = input.running != nullptr ? *input.running : s4tp_plan{};
    const s4tp_status status = s4tp_make_plan(block.get(), &input, &plan, &why);
    if (ready != S4TP_OK) {
      expect(status == S4TP_NOT_INITIALIZED && plan.kind == S4TP_PLAN_NONE,
             "without a planner nothing is written");
      break;
    }
    check(status, input, given, plan, setting);
    expect(why.status == status, "the explanation says the same");
    input.now_ms += 100U;
    s4tp_plan_point now;
    expect(s4tp_sample(&plan, input.now_ms, &now) == S4TP_OK && documented(now),
           "a plan can be read between its points");
    if (plan.kind != S4TP_PLAN_NONE) input.ego = driven_to(now, setting);
    input.running = bytes.byte() % 8 == 1 ? nullptr : &plan;
    given.honest = given.honest || input.running == nullptr;
    if (bytes.byte() % 8 == 1) {
      float* const numbers[] = {&plan.points[3].heading_rad,   &plan.points[4].speed_mps,
                                &plan.points[5].x_m,           &plan.points[6].acceleration_mps2,
                                &plan.points[7].curvature_1pm, &plan.fail_safe_branch_s,
                                &plan.fail_safe_braking_mps2};
      *numbers[bytes.below(7)] = bytes.take<float>();
      given.honest = input.running == nullptr;
    }
    tracks.left_out = bytes.byte() % 8 == 1 ? bytes.take<std::int16_t>() : 0;
    map->lanes_left_out = bytes.byte() % 8 == 1 ? bytes.take<std::int16_t>() : 0;
    given.map_sound = given.map_sound && map->lanes_left_out >= 0;
  }
  return 0;
}
