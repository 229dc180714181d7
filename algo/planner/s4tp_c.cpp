// The C facade: the planner in a caller's block.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <new>
#include <type_traits>

#include "algo/api/s4tp.h"
#include "algo/core/math.hpp"
#include "algo/core/parameter_info.hpp"
#include "algo/core/versions.hpp"
#include "algo/planner/c_conversion.hpp"
#include "algo/planner/planner.hpp"
#include "algo/satp/shipped_weights.hpp"
#include "algo/satp/weight_image.hpp"

#ifdef __FAST_MATH__
#error "s4tp gives identical bits everywhere; -ffast-math takes them away"
#endif

namespace s4tp::planner {
namespace {

/// What lies in a block, behind its seal.
struct Facade {
  Planner planner;
  PlannerInput input;
  LaneMap map;
  Plan running;
  Plan plan;
  Explanation explanation;
};

constexpr std::size_t kFacadeOffset = sizeof(std::uint64_t);
constexpr std::uint64_t kSeal = 0x7334'7470'0000'0000U + S4TP_API_VERSION;

static_assert(kFacadeOffset + sizeof(Facade) <= S4TP_BLOCK_BYTES, "S4TP_BLOCK_BYTES is too small");
static_assert(alignof(Facade) <= alignof(s4tp_block) && alignof(Facade) <= kFacadeOffset);
static_assert(std::is_trivially_destructible_v<Facade>, "a block is simply given up");

bool usable_address(const s4tp_block* block) {
  return block != nullptr && reinterpret_cast<std::uintptr_t>(block) % alignof(s4tp_block) == 0;
}

// With the address in it, so that a block that was copied elsewhere is not taken for an initialised one.
std::uint64_t seal_of(const s4tp_block* block) {
  return kSeal ^ (static_cast<std::uint64_t>(reinterpret_cast<std::uintptr_t>(block)) << 16U);
}

bool sealed(const s4tp_block* block) {
  std::uint64_t seal = 0;
  std::memcpy(&seal, block->bytes, sizeof(seal));
  return seal == seal_of(block);
}

void set_seal(s4tp_block* block, std::uint64_t seal) {
  std::memcpy(block->bytes, &seal, sizeof(seal));
}

Facade& facade_in(s4tp_block* block) {
  return *std::launder(reinterpret_cast<Facade*>(block->bytes + kFacadeOffset));
}

/// Fills facade.input. What is not as documented is left out. \return whether all was
bool take_input(const s4tp_input& from, Facade& facade) {
  PlannerInput& to = facade.input;
  to = PlannerInput{};
  to.now_ms = from.now_ms;
  to.start_ms = from.start_ms;
  to.ego = core_ego(from.ego);
  to.degraded = from.degraded;
  to.tracks_ms = from.now_ms;
  bool good = true;
  if (from.tracks != nullptr) {
    to.tracks_ms = from.tracks->time_ms;
    good = copy_tracks(*from.tracks, to.tracks);
  }
  if (from.map != nullptr) {
    const bool whole = copy_map(*from.map, facade.map);
    if (whole) to.map = &facade.map;
    good = good && whole;
  }
  if (from.running != nullptr) {
    const bool whole = copy_plan(*from.running, facade.running);
    if (whole) to.running = &facade.running;
    good = good && whole;
  }
  if (!good) to.map = nullptr;  // without a map the planner's answer is the minimum-risk manoeuvre
  return good;
}

}  // namespace
}  // namespace s4tp::planner

using namespace s4tp;  // the functions below are the C world's
using namespace s4tp::planner;

const char* s4tp_status_name(s4tp_status status) {
  switch (status) {
    case S4TP_OK:
      return "S4TP_OK";
    case S4TP_NOT_INITIALIZED:
      return "S4TP_NOT_INITIALIZED";
    case S4TP_INVALID_PARAMETER:
      return "S4TP_INVALID_PARAMETER";
    case S4TP_ARITHMETIC:
      return "S4TP_ARITHMETIC";
    case S4TP_INVALID_INPUT:
      return "S4TP_INVALID_INPUT";
    case S4TP_NO_LANE:
      return "S4TP_NO_LANE";
    case S4TP_NO_SAFE_PLAN:
      return "S4TP_NO_SAFE_PLAN";
    case S4TP_STALE_TRACKS:
      return "S4TP_STALE_TRACKS";
    case S4TP_INVALID_ARGUMENT:
      return "S4TP_INVALID_ARGUMENT";
    default:
      return "unknown status";
  }
}

s4tp_versions s4tp_get_versions(void) {
  static_assert(kWeightsVersion == satp::kWeightFormat);
  const bool carried = satp::shipped_weights().image != nullptr;
  return {kApiVersion, kWireVersion, kParametersVersion, carried ? kWeightsVersion : std::uint8_t{0}};
}

s4tp_status s4tp_default_parameters(s4tp_parameters* parameters) {
  if (parameters == nullptr) return S4TP_INVALID_ARGUMENT;
  std::memset(parameters, 0, sizeof(*parameters));
  const Parameters initial;
  for (int i = 0; i < kParameterCount; ++i) parameters->values[i] = get_parameter(initial, i);
  return S4TP_OK;
}

s4tp_status s4tp_set_parameter(s4tp_parameters* parameters, const char* name, float value) {
  if (parameters == nullptr || name == nullptr) return S4TP_INVALID_ARGUMENT;
  const int index = find_parameter(name);
  if (index < 0) return S4TP_INVALID_ARGUMENT;
  const ParameterInfo& row = parameter_info(index);
  if (!is_finite(value) || value < row.minimum || value > row.maximum) return S4TP_INVALID_PARAMETER;
  parameters->values[index] = value;
  return S4TP_OK;
}

s4tp_status s4tp_get_parameter(const s4tp_parameters* parameters, const char* name, float* value) {
  if (parameters == nullptr || name == nullptr || value == nullptr) return S4TP_INVALID_ARGUMENT;
  const int index = find_parameter(name);
  if (index < 0) return S4TP_INVALID_ARGUMENT;
  *value = parameters->values[index];
  return S4TP_OK;
}

int32_t s4tp_parameter_count(void) {
  return kParameterCount;
}

s4tp_status s4tp_describe_parameter(int32_t index, s4tp_parameter_info* info) {
  if (info == nullptr || index < 0 || index >= kParameterCount) return S4TP_INVALID_ARGUMENT;
  const ParameterInfo& row = parameter_info(index);
  *info = {row.name, row.unit, row.meaning, row.initial, row.minimum, row.maximum};
  return S4TP_OK;
}

uint32_t s4tp_parameters_crc(const s4tp_parameters* parameters) {
  return parameters == nullptr ? 0U : parameters_crc(core_parameters(*parameters));
}

s4tp_status s4tp_clear_map(s4tp_lane_map* map) {
  if (map == nullptr) return S4TP_INVALID_ARGUMENT;
  const Lane usual;
  std::memset(map, 0, sizeof(*map));
  for (s4tp_lane& lane : map->lanes) {
    lane.left = usual.left;
    lane.right = usual.right;
    for (int i = 0; i < kMaxSuccessors; ++i) lane.successors[i] = usual.successors[i];
    lane.width_m = usual.width_m;
    lane.speed_limit_mps = usual.speed_limit_mps;
    lane.stop_line_m = usual.stop_line_m;
  }
  return S4TP_OK;
}

s4tp_status s4tp_init(s4tp_block* block, const s4tp_parameters* parameters, const char** first_bad) {
  if (first_bad != nullptr) *first_bad = nullptr;
  if (!usable_address(block)) return S4TP_INVALID_ARGUMENT;
  set_seal(block, 0);
  Facade& facade = *new (block->bytes + kFacadeOffset) Facade;
  const Parameters values = parameters != nullptr ? core_parameters(*parameters) : Parameters{};
  const Status status = facade.planner.init(values);
  int index = 0;
  if (status == Status::kInvalidParameter && first_bad != nullptr && validate(values, index) == status) {
    *first_bad = parameter_info(index).name;
  }
  if (status == Status::kOk) set_seal(block, seal_of(block));
  return static_cast<s4tp_status>(status);
}

s4tp_status s4tp_make_plan(s4tp_block* block, const s4tp_input* input, s4tp_plan* plan,
                           s4tp_explanation* explanation) {
  if (!usable_address(block) || input == nullptr || plan == nullptr) return S4TP_INVALID_ARGUMENT;
  if (!sealed(block)) return S4TP_NOT_INITIALIZED;
  Facade& facade = facade_in(block);
  const bool good = take_input(*input, facade);
  Status status = facade.planner.plan(facade.input, facade.plan, facade.explanation);
  if (!good) status = Status::kInvalidInput;
  facade.explanation.status = status;
  copy_back(facade.plan, *plan);
  if (explanation != nullptr) copy_back(facade.explanation, *explanation);
  return static_cast<s4tp_status>(status);
}

s4tp_status s4tp_sample(const s4tp_plan* plan, uint32_t time_ms, s4tp_plan_point* point) {
  if (plan == nullptr || point == nullptr) return S4TP_INVALID_ARGUMENT;
  Plan copy;
  if (!copy_plan(*plan, copy)) return S4TP_INVALID_ARGUMENT;
  *point = c_point(sample(copy, time_ms));
  return S4TP_OK;
}
