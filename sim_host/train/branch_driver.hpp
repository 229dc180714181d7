#pragma once
/// Egos for branches: what one might do from here on, chosen without regard to what the others are about to
/// do (method.md 2). A driver of intentions is no planner: it keeps to its lane and, usually, behind who
/// drives ahead, but asks nobody whether it may enter a junction or a lane.

#include <cstdint>
#include <limits>
#include <vector>

#include "algo/core/parameters.hpp"
#include "algo/core/trajectory.hpp"
#include "firmware/ecu/tracker.hpp"
#include "sim_host/world/branch.hpp"
#include "sim_host/world/traffic/random.hpp"

namespace s4tp::train {

enum class Intention : std::uint8_t {
  kGo,         ///< on, up to a share of the limit, whoever comes
  kYield,      ///< stops before the next zone, waits, then goes
  kCreep,      ///< rolls to the zone, then slowly into it
  kBrake,      ///< slows down to a share of its speed, keeps that for a while, then goes
  kLeft,       ///< changes lane, where there is one, and goes
  kRight,      ///<
  kCandidate,  ///< one of the planner's own candidates for its 3 s, then goes
};
inline constexpr int kIntentions = 7;

struct BranchPlan {
  Intention intention = Intention::kGo;
  double acceleration_mps2 = 2.0;
  double braking_mps2 = 2.5;
  double limit_share = 1.0;  ///< of the lane's limit, that it drives
  double slow_share = 0.5;   ///< kBrake: of its speed
  double wait_s = 2.0;       ///< kYield, kBrake
  double creep_mps = 1.5;
  double change_s = 3.5;       ///< kLeft, kRight
  bool reckless = false;       ///< follows nobody
  Trajectory candidate;        ///< kCandidate; odometry frame
  std::uint32_t start_ms = 0;  ///< vehicle time of its first point
};

/// Draws the values of an intention; `candidate` and `start_ms` stay.
[[nodiscard]] BranchPlan draw_plan(Intention intention, traffic::Random& random);

/// The ego as the firmware's inputs would have it, without their errors.
[[nodiscard]] EgoState ego_state_of(const nodes::Vehicle& vehicle, map::Vec2 origin);

class BranchDriver final : public world::EgoDriver {
 public:
  /// What is the same in all branches of a fork.
  struct Fork {
    world::EgoCommand held;     ///< what the car does until the plan begins
    double lead_s = 0.1;        ///< until then
    std::uint32_t time_ms = 0;  ///< vehicle time of the fork
    map::Vec2 origin;           ///< of the odometry frame
    const Parameters* parameters = nullptr;
  };
  BranchDriver(const Fork& fork, const BranchPlan& plan) : fork_(fork), plan_(plan) {}

  [[nodiscard]] world::EgoCommand drive(const world::Branch& now) override;

 private:
  struct Part {
    map::LaneId lane = map::kNoLane;
    double start_m = 0.0;  ///< from our box centre
  };

  void begin(const world::Branch& now);
  void advance(const world::Branch& now);
  [[nodiscard]] std::vector<Part> way_ahead(const world::Branch& now) const;
  [[nodiscard]] map::LaneId next_of(const world::Branch& now, map::LaneId lane) const;
  [[nodiscard]] double wanted_mps(const world::Branch& now, const std::vector<Part>& way) const;
  [[nodiscard]] double behind_leader_mps2(const world::Branch& now, const std::vector<Part>& way,
                                          double wanted) const;
  struct Zone {
    /// From our box centre to where it waits for the nearest one.
    double wait_m = std::numeric_limits<double>::infinity();
    bool inside = false;  ///< it is in another one
  };
  [[nodiscard]] static Zone next_zone(const world::Branch& now, const std::vector<Part>& way);
  [[nodiscard]] double choose_mps2(const world::Branch& now, const std::vector<Part>& way);
  [[nodiscard]] double steer(const world::Branch& now, double plan_s) const;

  Fork fork_;
  BranchPlan plan_;
  ecu::Tracker tracker_;
  std::int64_t ticks_ = 0;
  map::LaneId lane_ = map::kNoLane;  ///< that it follows
  double s_m_ = 0.0;                 ///< of the box centre along it
  double offset_m_ = 0.0;            ///< from it when the plan began, left positive
  double brake_to_mps_ = 0.0;
  double stood_s_ = 0.0;
  bool released_ = false;  ///< waits no more
  world::EgoCommand command_;
};

}  // namespace s4tp::train
