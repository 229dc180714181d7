/// The optimizer alone, on made-up problems: the bits of what it finds, and what it costs in SysTick counts.
/// Exit code: 0 the bits are the golden ones, 1 they are not.

#include <cstring>

#include "algo/core/math.hpp"
#include "algo/trajectory/ilqr_backward.hpp"
#include "firmware/targets/platform.hpp"
#include "firmware/targets/text.hpp"

namespace s4tp::targets {
namespace {

constexpr int kProblems = 8;
constexpr int kPasses = 16;
constexpr std::uint32_t kGolden = 0xF11EB2AAU;  // as the host prints it

/// Braking in a bend that tightens, jerkier and nearer to others from one problem to the next.
void make_problem(int number, trajectory::RefinementProblem& problem) {
  const float share = static_cast<float>(number) / static_cast<float>(kProblems);
  problem = trajectory::RefinementProblem{};
  problem.weights = {0.0033F, 0.13F, 0.0033F, 0.0067F, 0.067F, 0.33F, 0.02F, 0.33F, 0.13F, 0.67F, 0.13F};
  problem.end_importance = 5.0F;
  problem.acceleration_low_mps2 = -7.8F;
  problem.acceleration_high_mps2 = 3.4F;
  problem.curvature_bound_1pm = 0.2F;
  problem.lateral_bound_mps2 = 4.4F;
  problem.comfort_gap_m = 1.0F;
  problem.centre_m = 1.5F;
  problem.half_length_m = 2.5F;
  problem.half_width_m = 0.9F;
  problem.start.speed_mps = 12.0F - 8.0F * share;
  trajectory::MotionState state = problem.start;
  for (int i = 0; i < kHorizonSteps; ++i) {
    trajectory::RefinementStep& step = problem.steps[i];
    const float time_s = kStepS * static_cast<float>(i);
    const float wave = sin((2.0F + 3.0F * share) * time_s);
    const trajectory::MotionInput input = {(4.0F + 6.0F * share) * wave - 2.0F, 0.03F * wave + 0.01F * share};
    state = trajectory::motion_step(state, input);
    step.reference = state;
    const SinCos heading = sin_cos(state.heading_rad);
    step.along_x = heading.cos;
    step.along_y = heading.sin;
    step.lane_offset_m = 0.4F * wave;
    step.speed_cap_mps = 11.0F - 7.0F * share;
    step.along_bound_m = min(1.0F, 0.5F * state.speed_mps + 0.02F);
    step.curvature_rate_weight = 0.13F + 0.0033F * square(square(state.speed_mps));
    step.input_bound = {12.0F, 0.3F};
    step.half_plane_count = number % 3;
    for (int k = 0; k < step.half_plane_count; ++k) {  // one beside, one ahead, both turned a little
      const SinCos turned = sin_cos(state.heading_rad + (k == 0 ? 1.4F : 3.0F));
      trajectory::HalfPlane& plane = step.half_planes[k];
      plane.normal_x = turned.cos;
      plane.normal_y = turned.sin;
      const float reach_m = k == 0 ? 1.3F : 4.3F;
      plane.offset_m = turned.cos * state.x_m + turned.sin * state.y_m - reach_m;
      plane.least_gap_m = 0.3F;
    }
  }
}

std::uint32_t hash(const void* data, std::size_t size, std::uint32_t value) {
  const auto* const bytes = static_cast<const unsigned char*>(data);
  for (std::size_t i = 0; i < size; ++i) value = (value ^ bytes[i]) * 16777619U;  // FNV-1a
  return value;
}

trajectory::RefinementProblem problem;
trajectory::Motion motion;
trajectory::Ilqr ilqr;
trajectory::InputCorrection corrections[kHorizonSteps];

}  // namespace

int run(const char*, bool) {
  std::uint32_t bits = 2166136261U;
  std::uint32_t pass_counts = 0;
  std::uint32_t solve_counts = 0;
  int passes = 0;
  int improved = 0;
  for (int number = 0; number < kProblems; ++number) {
    make_problem(number, problem);
    trajectory::reference_motion(problem, motion);
    trajectory::BoundState bounds;
    bounds.penalty = 1.0F;
    std::uint32_t began = counts_now();
    const float promised = trajectory::backward_pass(problem, bounds, motion, 0.0F, corrections);
    pass_counts += counts_now() - began;
    began = counts_now();
    const trajectory::IlqrResult result = ilqr.solve(problem, kPasses, motion);
    solve_counts += counts_now() - began;
    passes += result.passes;
    improved += result.improved ? 1 : 0;
    bits = hash(&promised, sizeof promised, bits);
    bits = hash(&motion, sizeof motion, bits);
  }
  Text line;
  line << "optimizer bits ";
  line.hex(bits, 8) << ", passes " << static_cast<std::int32_t>(passes) << ", improved "
                    << static_cast<std::int32_t>(improved) << ", counts: a backward pass "
                    << pass_counts / kProblems << ", a solve " << solve_counts / kProblems << "\n";
  print(line.c_str());
  return bits == kGolden ? 0 : 1;
}

}  // namespace s4tp::targets
