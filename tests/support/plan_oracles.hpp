#pragma once
/// Whether a vehicle can drive a plan of the C facade's: for whoever calls the planner with inputs of all kinds. The
/// arithmetic is in double and shares nothing with the core's; the bounds are those that the core promises.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numbers>

#include "algo/api/s4tp.h"

namespace s4tp::test {

/// From one point of a plan to the next.
struct PlanStep {
  PlanStep(const s4tp_plan_point& from, const s4tp_plan_point& to)
      : a(from), b(to), way_m(std::hypot(double{to.x_m} - from.x_m, double{to.y_m} - from.y_m)) {
    constexpr double kStepS = 0.001 * S4TP_PLAN_STEP_MS;
    driven_m = 0.5 * kStepS * (double{a.speed_mps} + b.speed_mps);
    gained_mps = double{b.speed_mps} - a.speed_mps;
    asked_mps = 0.5 * kStepS * (double{a.acceleration_mps2} + b.acceleration_mps2);
    turned_rad = wrapped(double{b.heading_rad} - a.heading_rad);
    bend_rad = 0.5 * way_m * (double{a.curvature_1pm} + b.curvature_1pm);
    most_1pm = std::max(std::abs(double{a.curvature_1pm}), std::abs(double{b.curvature_1pm}));
    way_rad = std::atan2(double{b.y_m} - a.y_m, double{b.x_m} - a.x_m);
    coarse_m = 1.2e-7 * (std::abs(double{a.x_m}) + std::abs(double{a.y_m}));
  }
  static double wrapped(double angle_rad) { return std::remainder(angle_rad, 2.0 * std::numbers::pi); }
  /// Of the way against the heading half way through a turn: along it lies an arc's chord.
  [[nodiscard]] double slip_rad(double turn_rad) const {
    return way_m > 0.0 ? std::abs(wrapped(way_rad - a.heading_rad - 0.5 * turn_rad)) : 0.0;
  }
  [[nodiscard]] bool rests() const { return a.speed_mps <= 0.0F && b.speed_mps <= 0.0F; }

  const s4tp_plan_point& a;
  const s4tp_plan_point& b;
  double way_m;       ///< from point to point
  double driven_m;    ///< as their speeds say
  double gained_mps;  ///< speed
  double asked_mps;   ///< as their accelerations say
  double turned_rad;  ///< from heading to heading
  double bend_rad;    ///< as their curvatures say
  double most_1pm;    ///< the larger of these
  double way_rad;     ///< direction of the way
  double coarse_m;    ///< what rounding to float moves two points apart by
};

class PlanOracles {
 public:
  explicit PlanOracles(const s4tp_parameters& parameters)
      : wheelbase_m_(value(parameters, "vehicle.wheelbase_m")),
        steering_rad_(value(parameters, "vehicle.steering_max_rad")),
        rate_radps_(value(parameters, "vehicle.steering_rate_max_radps")),
        drive_mps2_(value(parameters, "vehicle.acceleration_max_mps2")),
        braking_mps2_(value(parameters, "vehicle.braking_max_mps2")),
        lateral_mps2_(value(parameters, "comfort.lateral_max_mps2")) {}

  /// Null, or what does not hold of an answer S4TP_OK. \param honest  whether no running plan that was tampered with lies
  /// behind it
  [[nodiscard]] const char* drive(const s4tp_plan& plan, bool honest = true) const {
    Ruling ruling;
    keeps_limits(plan, ruling);
    is_feasible(plan, ruling);
    if (honest) is_smooth(plan, kTurnRad, ruling);
    return ruling.broken;
  }

  /// Null, or what does not hold of a minimum-risk manoeuvre. \param running  as it was handed in, or S4TP_PLAN_NONE
  [[nodiscard]] const char* stop(const s4tp_plan& plan, const s4tp_plan& running, bool honest = true) const {
    Ruling ruling;
    keeps_limits(plan, ruling);
    slows_down(plan, ruling);
    s4tp_plan_point begun;
    const auto elapsed_ms = static_cast<std::int32_t>(plan.start_ms - running.start_ms);
    const bool covers = running.kind != S4TP_PLAN_NONE && elapsed_ms >= 0 && elapsed_ms <= kPlanMs &&
                        s4tp_sample(&running, plan.start_ms, &begun) == S4TP_OK;
    if (!covers) {
      stays_steered(plan, ruling);
    } else if (std::memcmp(&begun, &plan.points[0], sizeof begun) == 0) {
      follows(plan, running, ruling);
      if (honest && running.kind == S4TP_PLAN_DRIVE) is_smooth(plan, kTurnRad, ruling);
    }  // Beside the plan its path is driven in parallel: where that begins it may have a kink.
    return ruling.broken;
  }

 private:
  /// The first rule that is broken.
  struct Ruling {
    const char* broken = nullptr;
    void require(bool holds, const char* rule) {
      if (!holds && broken == nullptr) broken = rule;
    }
  };

  static constexpr int kPlanMs = (S4TP_PLAN_POINTS - 1) * S4TP_PLAN_STEP_MS;
  static constexpr double kStepS = 0.001 * S4TP_PLAN_STEP_MS;
  static constexpr double kEgoSteeringRad = 0.8;  // the largest an ego state may have
  // plan_limits.cpp: of whatever the planner writes.
  static constexpr double kShare = 1.02;
  static constexpr double kCrawlMps = 0.08;
  static constexpr double kKinkRad = 0.3;
  static constexpr double kSlowM = 0.2;
  // bicycle.cpp: of whatever it sets out to drive.
  static constexpr double kFeasibleShare = 1.01;
  static constexpr double kRateRadps = 0.02;
  static constexpr double kLateralMps2 = 0.01;
  static constexpr double kWayShare = 0.05;
  static constexpr double kWayM = 0.05;
  static constexpr double kRounding = 1e-5;
  // A quintic beside a line: what the line's curvature does within a step, and d kappa' (roll_out.cpp leaves it out within
  // a metre: below 0.02 / m, over the 2.5 m of a step that bends so). Of 10^5 random plans the most were 0.013 and 0.039.
  static constexpr double kTurnRad = 0.05;
  static constexpr double kSlipRad = 0.05;
  static constexpr double kSampleM =
      1.0;  // between samples a line is straight: its heading is off by half their turn ...
  static constexpr double kSampleS = 0.0625;  // ... and at speed they lie further apart (reference_line.cpp)
  static constexpr double kRestMps =
      0.2;  // slower, accelerations are cut short (0.1 m/s in the optimizer, 0.15 else)
  static constexpr double kGainMps = 1e-3;
  static constexpr double kJerkMps3 = 12.0;  // speed_profile.cpp: at least, to brakes from drive

  static double value(const s4tp_parameters& parameters, const char* name) {
    float row = 0.0F;
    return s4tp_get_parameter(&parameters, name, &row) == S4TP_OK ? double{row} : std::nan("");
  }
  template <typename Rule>
  static void each_step(const s4tp_plan& plan, const Rule& rule) {
    for (int i = 1; i < S4TP_PLAN_POINTS; ++i) rule(PlanStep(plan.points[i - 1], plan.points[i]), i);
  }
  [[nodiscard]] double steering_rad(const s4tp_plan_point& point) const {
    return std::atan(wheelbase_m_ * point.curvature_1pm);
  }
  static double lateral_mps2(const s4tp_plan_point& point) {
    return double{point.speed_mps} * point.speed_mps * std::abs(double{point.curvature_1pm});
  }

  /// CAND-020: what every plan keeps to, and a running plan that was tampered with and still taken, too.
  void keeps_limits(const s4tp_plan& plan, Ruling& ruling) const {
    const double most_1pm = kShare * std::tan(kEgoSteeringRad) / wheelbase_m_ + kRounding;
    for (const s4tp_plan_point& point : plan.points) {
      ruling.require(point.acceleration_mps2 <= kShare * drive_mps2_ + kRounding &&
                         point.acceleration_mps2 >= -kShare * braking_mps2_ - kRounding,
                     "a plan keeps the vehicle's acceleration");
      ruling.require(std::abs(point.curvature_1pm) <= most_1pm, "a plan keeps what any wheels can steer");
    }
    each_step(plan, [&](const PlanStep& step, int) {
      ruling.require(step.gained_mps <= kShare * drive_mps2_ * kStepS + kCrawlMps + kRounding &&
                         step.gained_mps >= -kShare * braking_mps2_ * kStepS - kCrawlMps - kRounding,
                     "a plan's speeds follow from accelerations");
      ruling.require(
          std::abs(step.way_m - step.driven_m) <= kWayShare * step.driven_m + kWayM + step.coarse_m,
          "points lie as far apart as their speeds say");
      const double kinked_rad = step.most_1pm * step.way_m + kKinkRad + kRounding;
      ruling.require(std::abs(step.turned_rad) <= kinked_rad, "a plan has no kinks");
      ruling.require(step.way_m < kSlowM || kinked_rad > 1.0 ||
                         step.slip_rad(step.turned_rad) <= kinked_rad + step.coarse_m / kSlowM,
                     "a plan goes along its headings");
    });
  }

  /// CAND-003, CAND-004: the vehicle's limits, or what the plan begins with.
  void is_feasible(const s4tp_plan& plan, Ruling& ruling) const {
    const s4tp_plan_point& start = plan.points[0];
    const double steering_rad_most =
        kFeasibleShare * std::max(steering_rad_, std::abs(steering_rad(start))) + kRounding;
    const double lateral_most = std::max(lateral_mps2_, lateral_mps2(start)) + kLateralMps2 + kRounding;
    const double drive_most =
        kFeasibleShare * std::max(drive_mps2_, double{start.acceleration_mps2}) + kRounding;
    const double braking_most =
        kFeasibleShare * std::max(braking_mps2_, -double{start.acceleration_mps2}) + kRounding;
    each_step(plan, [&](const PlanStep& step, int) {
      ruling.require(std::abs(steering_rad(step.b)) <= steering_rad_most, "a plan keeps the steering angle");
      ruling.require(std::abs(steering_rad(step.b) - steering_rad(step.a)) <=
                         (rate_radps_ + kRateRadps) * kStepS + kRounding,
                     "a plan keeps the steering rate");
      ruling.require(lateral_mps2(step.b) <= lateral_most, "a plan keeps the lateral acceleration");
      ruling.require(step.b.acceleration_mps2 <= drive_most && step.b.acceleration_mps2 >= -braking_most,
                     "a plan keeps the vehicle's acceleration");
    });
  }

  /// It turns as its curvature says, goes where it heads, and gains the speed its accelerations say.
  static void is_smooth(const s4tp_plan& plan, double turn_rad, Ruling& ruling) {
    const double sample_m = std::max(kSampleM, kSampleS * plan.points[0].speed_mps);
    each_step(plan, [&](const PlanStep& step, int i) {
      ruling.require(std::abs(PlanStep::wrapped(step.turned_rad - step.bend_rad)) <=
                         turn_rad + step.most_1pm * step.coarse_m,
                     "a plan turns as its curvature says");
      ruling.require(
          step.way_m < kSlowM || step.slip_rad(step.bend_rad) <=
                                     kSlipRad + 0.5 * step.most_1pm * sample_m + step.coarse_m / kSlowM,
          "a plan's way lies along its heading");
      // Where a plan begins it may be a little off the running one that it goes on with.
      ruling.require(
          i == 1 || step.b.speed_mps < kRestMps || std::abs(step.gained_mps - step.asked_mps) <= kGainMps,
          "a plan gains the speed its accelerations say");
      ruling.require(!step.rests() || std::memcmp(&step.a, &step.b, 3 * sizeof(float)) == 0,
                     "at rest the pose stays");
    });
  }

  /// FAIL-003.
  static void slows_down(const s4tp_plan& plan, Ruling& ruling) {
    each_step(plan, [&](const PlanStep& step, int i) {
      ruling.require(!step.rests() || std::memcmp(&step.a, &step.b, 3 * sizeof(float)) == 0,
                     "at rest the pose stays");
      if (i * kStepS <= plan.fail_safe_branch_s + kGainMps) return;
      const double before_mps2 = std::max(0.0, double{step.a.acceleration_mps2});
      const double left_mps2 = std::max(0.0, before_mps2 - kJerkMps3 * kStepS);
      ruling.require(step.gained_mps <= before_mps2 * kStepS + kRounding &&
                         step.b.acceleration_mps2 <= left_mps2 + kRounding,
                     "a stop takes back its acceleration after the branch");
    });
  }

  /// FAIL-002.
  static void stays_steered(const s4tp_plan& plan, Ruling& ruling) {
    for (const s4tp_plan_point& point : plan.points)
      ruling.require(point.curvature_1pm == plan.points[0].curvature_1pm, "without a plan the wheels stay");
    is_smooth(plan, kRounding, ruling);
  }

  /// FAIL-001, begun on the running plan: steered no further than that, and no faster through its bends but for braking
  /// that begins a step late. Its wheels turn where the plan's did, however fast: their rate is not promised.
  void follows(const s4tp_plan& plan, const s4tp_plan& running, Ruling& ruling) const {
    double steering_most = 0.0;
    double lateral_most = lateral_mps2_;
    for (const s4tp_plan_point& point : running.points) {
      steering_most = std::max(steering_most, std::abs(steering_rad(point)));
      lateral_most = std::max(lateral_most, lateral_mps2(point));
    }
    const double late_mps = (drive_mps2_ + braking_mps2_) * kStepS;
    for (const s4tp_plan_point& point : plan.points) {
      ruling.require(std::abs(steering_rad(point)) <= steering_most + kRounding,
                     "a stop steers no further than the plan did");
      const double bend_mps = std::sqrt(lateral_most / std::max(1e-9, std::abs(double{point.curvature_1pm})));
      ruling.require(point.speed_mps <= bend_mps + late_mps, "a stop is no faster than bends allow");
    }
  }

  double wheelbase_m_;
  double steering_rad_;
  double rate_radps_;
  double drive_mps2_;
  double braking_mps2_;
  double lateral_mps2_;
};

}  // namespace s4tp::test
