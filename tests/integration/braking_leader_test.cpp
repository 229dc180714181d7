// The one ahead brakes as hard as a car can, while something goes wrong on the bus: from the RSS distance of the reaction that
// the fault leaves nobody is hit. Which reaction that is stands in docs/safety.md; the numbers of its table are read from there.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <ostream>
#include <sstream>
#include <string>
#include <vector>

#include "firmware/can/frames.hpp"
#include "hal/sim/bus.hpp"
#include "hal/sim/null_devices.hpp"
#include "sim_host/baselines/any_ecu.hpp"
#include "sim_host/faults/faulty_bus.hpp"
#include "sim_host/world/ego_road.hpp"
#include "sim_host/world/nodes/vehicle_node.hpp"
#include "sim_host/world/nodes/world_nodes.hpp"
#include "tests/support/networks.hpp"

namespace s4tp::faults {
namespace {

constexpr double kHardest_mps2 = 8.0;
constexpr double kFollowing_mps = 11.0;
constexpr double kLength_m = 5.0;
constexpr int kEntry = 300;     // ticks
constexpr int kAppears = 700;   // since entry
constexpr int kSeen = 50;       // ticks that a leader who appears has been there when it brakes
constexpr int kSettled = 1200;  // by then it is followed at the planner's own distance
constexpr int kStands = 900;    // ticks after it has braked, at most: the field has the last metre crept

/// A fault and its name in the table.
struct Case {
  const char* name;
  FaultKind kind;
  std::vector<const char*> messages;
  int intensity;
};

void PrintTo(const Case& fault, std::ostream* out) {
  *out << fault.name;
}

const std::vector<const char*> kVehicle{"Motion", "Steering", "Pose"};
const std::vector<const char*> kPerception{"TrackList", "TrackPose", "TrackMotion"};
const std::vector<const char*> kAll{
    "Motion",        "Steering",       "Pose",       "TrackList",    "TrackPose", "TrackMotion",
    "MapHeader",     "MapSlots",       "LaneHeader", "LaneRoute",    "LaneLinks", "LanePoint",
    "ConflictFirst", "ConflictSecond", "MapOrigin",  "VersionWorld", "Command"};

const std::vector<Case> kCases{
    {"none", FaultKind::kDuplicate, {"Tick"}, 1},
    {"every frame twice", FaultKind::kDuplicate, kAll, 100},
    {"frames in any order", FaultKind::kReorder, kAll, 100},
    {"lists stop", FaultKind::kDeadPerception, kPerception, 0},
    {"half of the lists lost", FaultKind::kLoss, {"TrackList"}, 50},
    {"lists up to 400 ms late", FaultKind::kDelay, kPerception, 40},
    {"map stops", FaultKind::kDeadMap, {"MapHeader", "MapSlots"}, 0},
    {"motion stops", FaultKind::kLoss, {"Motion"}, 100},
    {"steering stops", FaultKind::kLoss, {"Steering"}, 100},
    {"pose stops", FaultKind::kLoss, {"Pose"}, 100},
    {"all the vehicle says stops", FaultKind::kDeadVehicle, kVehicle, 0},
    {"what the vehicle says up to 400 ms late", FaultKind::kDelay, kVehicle, 40},
    {"half of all frames lost", FaultKind::kLoss, kAll, 50},
    {"half of all frames damaged", FaultKind::kCorrupt, kAll, 50},
    {"all frames damaged", FaultKind::kCorrupt, kAll, 100},
    {"a flood of 700 frames a tick", FaultKind::kBurst, {}, 700},
    {"every plan late", FaultKind::kLatePlan, {}, 100},
    {"frames of anybody's, 10 a tick", FaultKind::kBabble, kAll, 10},
    {"motion 3 ms early, each", FaultKind::kEarlyMotion, {"Motion", "TrackList"}, 3},
    {"motion 100 ms late, each", FaultKind::kLateMotion, {"Motion", "TrackList"}, 100},
    {"all stamps 0.5 s off", FaultKind::kClockJump, {"Motion", "TrackList"}, 500},
    {"all stamps 0.5 s back", FaultKind::kClockJump, {"Motion", "TrackList"}, -500},
    {"commands stop", FaultKind::kLoss, {"Command"}, 100},
    {"commands up to 400 ms late", FaultKind::kDelay, {"Command"}, 40},
    {"off the bus", FaultKind::kBusOff, {}, 0},
};

MessageSet set_of(const std::vector<const char*>& names) {
  MessageSet set = 0;
  for (const char* const name : names) {
    for (int i = 0; i < kMessageCount; ++i) {
      if (std::string(message(i).name) == name) set |= 1U << static_cast<unsigned>(i);
    }
  }
  return set;
}

/// What the ECU, or the vehicle without it, still does: after so long it brakes so hard.
struct Reaction {
  double response_s = -1.0;
  double braking_mps2 = 0.0;
  double distance_m = 0.0;  ///< at 11 m/s each
};

Reaction promised(const std::string& name) {
  std::ifstream page(std::filesystem::path(S4TP_SOURCE_DIR) / "docs" / "safety.md");
  const std::string head = "| " + name + " | ";
  Reaction reaction;
  for (std::string line; std::getline(page, line);) {
    if (line.rfind(head, 0) != 0) continue;
    std::istringstream cells(line.substr(line.find(" | ", head.size()) + 3));
    char bar = '|';
    cells >> reaction.response_s >> bar >> reaction.braking_mps2 >> bar >> reaction.distance_m;
  }
  return reaction;
}

double rss_m(const Reaction& reaction, double speed_mps, double leader_mps) {
  return std::max(0.0, speed_mps * reaction.response_s +
                           speed_mps * speed_mps / (2.0 * reaction.braking_mps2) -
                           leader_mps * leader_mps / (2.0 * kHardest_mps2));
}

/// Without the risk field nothing but the guard keeps us off.
Parameters parameters_of(bool field) {
  Parameters parameters;
  if (!field) parameters.scoring.risk = 0.0F;
  return parameters;
}

/// The vehicle and its ECU on a straight road, a leader that a test drives, and the fault between them.
class Road {
 public:
  explicit Road(bool field) {
    scenario_.mission = {};
    ecu_ = baselines::make_ecu("s4tp", true, parameters_of(field),
                               {ecu_port_, &cycles_, &watchdog_, nullptr, nullptr}, nullptr);
    vehicle_.vehicle().place({20.0 - 0.01 * kFollowing_mps * kEntry, 0.0}, 0.0, kFollowing_mps);
  }

  void tick(FaultyBus& faults, const std::vector<traffic::CarState>& others) {
    ++tick_;
    if (since_entry() <= 0) {
      vehicle_.vehicle().place({20.0 + 0.01 * kFollowing_mps * since_entry(), 0.0}, 0.0, kFollowing_mps);
      vehicle_.idle();
    } else {
      vehicle_.drive();
    }
    std::vector<wire::Frame> frames;
    const auto now_ms = static_cast<std::uint32_t>(10 * tick_);
    vehicle_.publish(now_ms, since_entry() >= 0, frames);
    const traffic::LanePlace place{0, vehicle_.vehicle().box_centre().x, vehicle_.vehicle().box_centre().y,
                                   true};
    nodes_.publish(now_ms, world::ego_state(vehicle_.vehicle(), place), others, frames);
    ecu_port_->set_state(faults.controller(since_entry()));
    for (const wire::Frame& frame : faults.to_ecu(since_entry(), frames))
      (void)world_port_->send(to_hal(frame));
    if (faults.plan_late(since_entry()) && tick_ % 10 == 0) ecu_->inject_deadline_miss();
    ecu_->control_tick();
    if (ecu_->planning_due()) ecu_->planning_cycle();
    std::vector<wire::Frame> sent;
    hal::CanFrame frame;
    while (world_port_->receive(frame)) sent.push_back(to_wire(frame));
    for (const wire::Frame& each : faults.to_world(since_entry(), sent)) vehicle_.receive(each);
  }

  [[nodiscard]] int since_entry() const { return tick_ - kEntry; }
  [[nodiscard]] double front_m() const { return vehicle_.vehicle().box_centre().x + 0.5 * kLength_m; }
  [[nodiscard]] double speed_mps() const { return vehicle_.vehicle().speed_mps(); }
  [[nodiscard]] ecu::Mode mode() const { return ecu_->core().mode(); }

 private:
  scenario::Scenario scenario_;
  map::Network network_ = test::network_of(
      R"(<net><edge id="road"><lane id="road_0" index="0" speed="13.75" width="3.2" shape="0,0 1200,0"/></edge></net>)");
  map::RouteGuide guide_{network_, {"road"}, 0, 1150.0};
  nodes::VehicleNode vehicle_{{}, {0.0, 0.0}, 1};
  nodes::WorldNodes nodes_{network_, guide_, {0.0, 0.0}, {}, 1};
  hal::sim::Bus bus_;
  hal::sim::Bus::Port* world_port_ = bus_.attach();
  hal::sim::Bus::Port* ecu_port_ = bus_.attach();
  hal::sim::NullCycleCounter cycles_;
  hal::sim::NullWatchdog watchdog_;
  std::unique_ptr<baselines::AnyEcu> ecu_;
  int tick_ = 0;
};

struct Outcome {
  double least_gap_m = 1e3;
  double braked_at_m = 0.0;  ///< gap when the leader brakes
  double speed_mps = 0.0;
  bool stood = false;
};

/// A leader that was there from the start and drives steadily, or one that comes in `kSeen` ticks before it brakes.
class Leader {
 public:
  explicit Leader(bool appears) : appears_(appears) {
    car_.id = 7;
    car_.length_m = kLength_m;
    car_.speed_mps = kFollowing_mps;
    car_.centre = {45.0, 0.0};
  }

  void tick(const Road& road, const Reaction& reaction, bool brakes) {
    if (appears_ && road.since_entry() == kAppears) {
      car_.speed_mps = road.speed_mps();
      car_.centre.x = road.front_m() + rss_m(reaction, road.speed_mps(), road.speed_mps()) + 0.5 * kLength_m;
    }
    car_.acceleration_mps2 = brakes && car_.speed_mps > 0.0 ? -kHardest_mps2 : 0.0;
    car_.speed_mps = std::max(0.0, car_.speed_mps + 0.01 * car_.acceleration_mps2);
    car_.centre.x += 0.01 * car_.speed_mps;
  }

  [[nodiscard]] std::vector<traffic::CarState> seen(const Road& road) const {
    if (appears_ && road.since_entry() <= kAppears) return {};
    return {car_};
  }
  [[nodiscard]] double gap_m(const Road& road) const {
    return car_.centre.x - 0.5 * kLength_m - road.front_m();
  }
  /// More than the distance of the reaction.
  [[nodiscard]] double spare_m(const Road& road, const Reaction& reaction) const {
    return gap_m(road) - rss_m(reaction, road.speed_mps(), car_.speed_mps);
  }

 private:
  traffic::CarState car_;
  bool appears_;
};

/// Since entry: when the leader that is followed is only as far away as the reaction takes, or has been followed for long.
int brakes_at(const Reaction& reaction) {
  const auto road = std::make_unique<Road>(true);
  Leader leader(false);
  const FaultScript none;
  FaultyBus well(none);
  while (road->since_entry() < kSettled) {
    road->tick(well, leader.seen(*road));
    leader.tick(*road, reaction, false);
    if (road->since_entry() > 100 && leader.spare_m(*road, reaction) < 0.2) break;
  }
  return road->since_entry();
}

/// \param onset  ticks from the leader's braking to the fault
Outcome follow(const Case& fault, const Reaction& reaction, int brakes, int onset, bool appears, bool field) {
  const auto road = std::make_unique<Road>(field);
  Leader leader(appears);
  FaultScript script;
  script.faults.push_back({fault.kind, brakes + onset, kForGood, set_of(fault.messages), fault.intensity, 1});
  FaultyBus bus(script);
  Outcome outcome;
  while (!outcome.stood && road->since_entry() < brakes + kStands) {
    const int tick = road->since_entry();
    road->tick(bus, leader.seen(*road));
    leader.tick(*road, reaction, tick >= brakes);
    if (tick == brakes + std::min(onset, 0) - 2) {
      EXPECT_EQ(road->mode(), ecu::Mode::kDriving);
    }
    if (tick < brakes) continue;
    if (tick == brakes) outcome.braked_at_m = leader.gap_m(*road);
    if (tick == brakes) {
      EXPECT_GT(leader.spare_m(*road, reaction), -0.1);
    }
    outcome.least_gap_m = std::min(outcome.least_gap_m, leader.gap_m(*road));
    outcome.speed_mps = road->speed_mps();
    outcome.stood = tick > brakes && outcome.speed_mps < 0.05;
  }
  return outcome;
}

class BrakingLeader : public testing::TestWithParam<Case> {};

// ECU-005 ECU-010 .. ECU-022, WORLD-003, CORE-030, LEGAL-005: for each fault of the bus, from half a second before the leader
// brakes to 0.4 s after, whether it has been followed for long or has just come in at the very distance. In the risk field we brake
// before such a leader does; that the table's distance is needed shows without.
TEST_P(BrakingLeader, IsNotHitFromTheDistanceOfTheReactionLeft) {
  const Reaction reaction = promised(GetParam().name);
  ASSERT_GT(reaction.response_s, 0.0) << "docs/safety.md has no row: " << GetParam().name;
  EXPECT_NEAR(rss_m(reaction, kFollowing_mps, kFollowing_mps), reaction.distance_m, 0.05);
  for (const bool appears : {false, true}) {
    const int brakes = appears ? kAppears + kSeen : brakes_at(reaction);
    double least_m = 1e3;
    double alone_m = 1e3;  // without the field
    double braked_at_m = 0.0;
    for (const int onset : {-50, -20, 0, 10, 20, 30, 40}) {
      if (appears && onset < -20) continue;  // a fault may not hide who was never seen
      const Outcome outcome = follow(GetParam(), reaction, brakes, onset, appears, true);
      EXPECT_GT(outcome.least_gap_m, 0.0)
          << GetParam().name << ", from " << 10 * onset << " ms, appears " << appears;
      EXPECT_TRUE(outcome.stood) << GetParam().name << ", from " << 10 * onset << " ms, still "
                                 << outcome.speed_mps << " m/s";
      least_m = std::min(least_m, outcome.least_gap_m);
      braked_at_m = std::max(braked_at_m, outcome.braked_at_m);
      if (appears)
        alone_m = std::min(alone_m, follow(GetParam(), reaction, brakes, onset, appears, false).least_gap_m);
    }
    if (appears) {
      EXPECT_LT(alone_m, 4.0) << GetParam().name << ": the table asks for more than is needed";
    }
    std::printf("%s: the leader %s, brakes %.1f m ahead (RSS %.1f m), least gap %.2f m", GetParam().name,
                appears ? "appears" : "was followed", braked_at_m, reaction.distance_m, least_m);
    if (appears) std::printf(", without the field %.2f m", alone_m);
    std::printf("\n");
  }
}

INSTANTIATE_TEST_SUITE_P(Faults, BrakingLeader, testing::ValuesIn(kCases),
                         [](const auto& one) { return "Fault" + std::to_string(one.index); });

}  // namespace
}  // namespace s4tp::faults
