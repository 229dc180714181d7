// What an ECU tells over DDS, as Fast DDS reads it.
#include <gtest/gtest.h>
#include <ros.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "sim_host/processes/child_process.hpp"
#include "sim_host/telemetry/derive.hpp"
#include "sim_host/telemetry/ecu_tap.hpp"
#include "sim_host/telemetry/watch.hpp"
#include "sim_host/view/plan_words.hpp"
#include "tests/dds/drive.hpp"
#include "tests/dds/ros_reader.hpp"
#include "tests/dds/wait_for.hpp"

namespace s4tp {
namespace {

using namespace std::chrono_literals;
using tests::Drive;
using tests::free_domain;
using tests::kTelemetry;
using tests::memory_name;
using tests::RosNode;
using tests::RosReader;
using tests::wait_for;

template <class Stamp>
double seconds(const Stamp& stamp) {
  return stamp.sec() + 1e-9 * stamp.nanosec();
}

// Tests that run at once do not hear each other: who begins to look where another did finds the next domain.
TEST(Domains, AreClaimedOnce) {
  const std::uint32_t one = tests::claim_domain(7);
  const std::uint32_t other = tests::claim_domain(7);
  EXPECT_NE(one, other);
  EXPECT_GE(std::min(one, other), 20U);
  EXPECT_LT(std::max(one, other), 220U);
}

// TELE-001 TELE-003 TELE-004 TELE-010..012 TELE-020..030 TELE-032 Another vendor's subscriber gets every topic,
// and in each what the ECU's records say.
TEST(Topics, ReachFastDdsWithTheRightValues) {
  const auto tap = std::make_unique<telemetry::EcuTap>();
  hal::linux_host::Reason reason;
  ASSERT_TRUE(tap->open(memory_name(), "s4tp", "in process", Parameters{}, reason)) << reason.text;
  Drive drive(tap.get());
  const std::string domain = std::to_string(free_domain());
  processes::ChildProcess process({kTelemetry, "--ecu", memory_name(), "--domain", domain});

  RosNode node(free_domain());
  namespace perception = autoware_perception_msgs::msg;
  RosReader<perception::TrackedObjects> tracked(node, "rt/s4tp/tracked_objects", "autoware_perception_msgs",
                                                "TrackedObjects", false);
  RosReader<perception::PredictedObjects> predicted(node, "rt/s4tp/predicted_objects",
                                                    "autoware_perception_msgs", "PredictedObjects", false);
  RosReader<autoware_planning_msgs::msg::Trajectory> trajectory(node, "rt/s4tp/trajectory",
                                                                "autoware_planning_msgs", "Trajectory", true);
  RosReader<autoware_planning_msgs::msg::Trajectory> fail_safe(node, "rt/s4tp/fail_safe",
                                                               "autoware_planning_msgs", "Trajectory", true);
  RosReader<visualization_msgs::msg::MarkerArray> candidates(node, "rt/s4tp/candidates", "visualization_msgs",
                                                             "MarkerArray", true);
  RosReader<autoware_control_msgs::msg::Control> control(node, "rt/s4tp/control", "autoware_control_msgs",
                                                         "Control", false);
  RosReader<nav_msgs::msg::OccupancyGrid> risk(node, "rt/s4tp/risk", "nav_msgs", "OccupancyGrid", true);
  RosReader<nav_msgs::msg::Path> path(node, "rt/s4tp/path", "nav_msgs", "Path", true);
  RosReader<visualization_msgs::msg::MarkerArray> lanes(node, "rt/s4tp/lanes", "visualization_msgs",
                                                        "MarkerArray", true);
  RosReader<std_msgs::msg::String> words(node, "rt/s4tp/explanation", "std_msgs", "String", true);
  RosReader<diagnostic_msgs::msg::DiagnosticArray> diagnostics(node, "rt/diagnostics", "diagnostic_msgs",
                                                               "DiagnosticArray", true);
  RosReader<tf2_msgs::msg::TFMessage> tf(node, "rt/tf", "tf2_msgs", "TFMessage", false);
  ASSERT_TRUE(wait_for([&] {
    return tracked.matched() && predicted.matched() && trajectory.matched() && fail_safe.matched() &&
           candidates.matched() && control.matched() && risk.matched() && path.matched() && lanes.matched() &&
           words.matched() && diagnostics.matched() && tf.matched();
  })) << "not all topics were found";

  // The other side may learn of its readers later than they learn of it: nothing is told to nobody.
  const auto everybody_reads = [&] {
    drive.ticks(1, 10ms);
    return trajectory.count() > 0 && fail_safe.count() > 0 && control.count() > 0 && risk.count() > 0 &&
           words.count() > 0 && tracked.count() > 0 && predicted.count() > 0;
  };
  ASSERT_TRUE(wait_for(everybody_reads));
  ASSERT_LT(drive.ticks_driven(), 900) << "the readers were found too late";
  drive.ticks(900 - drive.ticks_driven(), 0ms);  // to where the others are
  const int commands = control.count();
  drive.ticks(60, 10ms);
  EXPECT_TRUE(wait_for([&] { return control.count() >= commands + 50; }, 2s))
      << "of 60 commands came " << control.count() - commands;

  telemetry::Watch watch(memory_name());
  (void)watch.look();
  ASSERT_TRUE(watch.present()) << watch.absence();
  const ecu::PlanRecord& plan = watch.plan();
  ASSERT_EQ(plan.plan.kind, PlanKind::kDrive);
  ASSERT_NE(watch.cycle(), nullptr);
  const telemetry::CycleRecord& cycle = *watch.cycle();
  ASSERT_GT(cycle.scene.agents.size(), 0);
  ASSERT_GT(cycle.prediction.agents.size(), 0);
  const double start_s = 0.001 * plan.plan.start_ms;
  ASSERT_TRUE(
      wait_for([&] { return std::abs(seconds(fail_safe.last().header().stamp()) - start_s) < 1e-9; }));
  ASSERT_TRUE(wait_for(
      [&] { return std::abs(seconds(control.last().stamp()) - 0.001 * watch.control().time_ms) < 0.1; }));
  ASSERT_TRUE(wait_for(
      [&] { return std::abs(seconds(risk.last().header().stamp()) - 0.001 * cycle.scene.time_ms) < 1e-9; }));

  const auto got_plan = trajectory.last();
  EXPECT_EQ(got_plan.header().frame_id(), "odom");
  ASSERT_EQ(got_plan.points().size(), static_cast<std::size_t>(kTrajectoryPoints));
  const auto got_path = path.last();
  ASSERT_EQ(got_path.poses().size(), static_cast<std::size_t>(kTrajectoryPoints));
  for (int i = 0; i < kTrajectoryPoints; ++i) {
    const TrajectoryPoint& sent = plan.plan.trajectory.points[i];
    const auto& got = got_plan.points()[static_cast<std::size_t>(i)];
    EXPECT_EQ(got.pose().position().x(), static_cast<double>(sent.rear_axle.x_m));
    EXPECT_EQ(got.pose().position().y(), static_cast<double>(sent.rear_axle.y_m));
    EXPECT_NEAR(2.0 * std::atan2(got.pose().orientation().z(), got.pose().orientation().w()),
                sent.rear_axle.heading_rad, 1e-6);
    EXPECT_EQ(got.longitudinal_velocity_mps(), sent.speed_mps);
    EXPECT_EQ(got.acceleration_mps2(), sent.acceleration_mps2);
    EXPECT_NEAR(got.front_wheel_angle_rad(), std::atan(2.9F * sent.curvature_1pm), 1e-6);
    EXPECT_NEAR(seconds(got.time_from_start()), 0.1 * i, 1e-9);
    EXPECT_EQ(got_path.poses()[static_cast<std::size_t>(i)].pose().position().x(),
              static_cast<double>(sent.rear_axle.x_m));
  }
  const Plan stop = telemetry::fail_safe_of(plan, Parameters{});
  const auto got_stop = fail_safe.last();
  ASSERT_EQ(got_stop.points().size(), static_cast<std::size_t>(kTrajectoryPoints));
  EXPECT_EQ(got_stop.points()[30].longitudinal_velocity_mps(), stop.trajectory.points[30].speed_mps);
  EXPECT_LE(got_stop.points()[30].longitudinal_velocity_mps(),
            got_stop.points()[0].longitudinal_velocity_mps());

  const auto got_tracks = tracked.last();
  ASSERT_EQ(got_tracks.objects().size(), static_cast<std::size_t>(cycle.scene.agents.size()));
  for (int i = 0; i < cycle.scene.agents.size(); ++i) {
    const Track& sent = cycle.scene.agents[i].track;
    const auto& got = got_tracks.objects()[static_cast<std::size_t>(i)];
    EXPECT_EQ(got.object_id().uuid()[15], sent.id);
    EXPECT_EQ(got.kinematics().pose_with_covariance().pose().position().x(),
              static_cast<double>(sent.centre.x_m));
    EXPECT_EQ(got.kinematics().twist_with_covariance().twist().linear().x(),
              static_cast<double>(sent.speed_mps));
    EXPECT_EQ(got.shape().dimensions().x(), static_cast<double>(sent.length_m));
    ASSERT_EQ(got.classification().size(), 1U);
    EXPECT_EQ(got.classification()[0].label(), 1);
  }
  const auto got_futures = predicted.last();
  ASSERT_EQ(got_futures.objects().size(), static_cast<std::size_t>(cycle.prediction.agents.size()));
  for (int i = 0; i < cycle.prediction.agents.size(); ++i) {
    const satp::AgentPrediction& sent = cycle.prediction.agents[i];
    const auto& paths = got_futures.objects()[static_cast<std::size_t>(i)].kinematics().predicted_paths();
    ASSERT_EQ(paths.size(), static_cast<std::size_t>(sent.modes.size()));
    float sum = 0.0F;
    for (int k = 0; k < sent.modes.size(); ++k) {
      const auto& future = paths[static_cast<std::size_t>(k)];
      EXPECT_EQ(future.confidence(), sent.modes[k].probability);
      ASSERT_EQ(future.path().size(), static_cast<std::size_t>(kHorizonSteps));
      EXPECT_EQ(future.path()[29].position().y(), static_cast<double>(sent.modes[k].steps[29].y_m));
      EXPECT_EQ(future.time_step().nanosec(), 100'000'000U);
      sum += future.confidence();
    }
    EXPECT_NEAR(sum, 1.0F, 1e-5F);
  }

  // The chosen one ends where the plan was to, before it was refined.
  const auto expected = telemetry::candidates_of(plan, cycle, Parameters{});
  ASSERT_GT(expected.size(), 3U);
  int lines = 0;
  const auto got_candidates = candidates.last();  // kept: the loop has no hold of what last() gives
  for (const auto& marker : got_candidates.markers()) {
    if (marker.type() != 4) continue;
    ASSERT_LT(static_cast<std::size_t>(marker.id()), expected.size());
    ASSERT_EQ(marker.points().size(), static_cast<std::size_t>(kTrajectoryPoints));
    EXPECT_EQ(marker.points()[30].x(),
              static_cast<double>(
                  expected[static_cast<std::size_t>(marker.id())].trajectory.points[30].rear_axle.x_m));
    ++lines;
  }
  EXPECT_EQ(lines, cycle.candidates.size());
  EXPECT_EQ(std::count_if(expected.begin(), expected.end(), [](const auto& one) { return one.chosen; }), 1);

  const auto got_risk = risk.last();
  EXPECT_EQ(got_risk.info().width(), static_cast<std::uint32_t>(sadrf::kHeatColumns));
  ASSERT_EQ(got_risk.data().size(), static_cast<std::size_t>(sadrf::kHeatColumns * sadrf::kHeatRows));
  const sadrf::HeatMap heat = telemetry::heat_map_of(plan, cycle, Parameters{});
  int vehicle = 0;
  int risky = 0;
  for (int i = 0; i < sadrf::kHeatColumns * sadrf::kHeatRows; ++i) {
    const std::uint8_t level = heat.cells[i / sadrf::kHeatColumns][i % sadrf::kHeatColumns];
    const int value = static_cast<signed char>(got_risk.data()[static_cast<std::size_t>(i)]);
    if (level == sadrf::kHeatVehicle) {
      EXPECT_EQ(value, 100);
      ++vehicle;
    } else if (level <= sadrf::kHeatHighest) {
      EXPECT_EQ(value, level * 99 / 239);
      risky += level > 0 ? 1 : 0;
    }
  }
  EXPECT_GT(vehicle, 0);
  EXPECT_GT(risky, 0);

  // Best effort: the very last one may be lost, and commands change by little in 0.1 s.
  EXPECT_NEAR(control.last().longitudinal().acceleration(), watch.control().sent.acceleration_mps2, 0.5F);
  EXPECT_NEAR(control.last().lateral().steering_tire_angle(), watch.control().sent.steering_rad, 0.05F);
  EXPECT_EQ(words.last().data().substr(0, words.last().data().find('\n')),
            view::in_words(telemetry::trace_of(plan, &cycle, {})));
  int present = 0;
  for (const Lane& lane : cycle.map.lanes) present += lane.present ? 1 : 0;
  EXPECT_EQ(lanes.last().markers().size(), static_cast<std::size_t>(present) + 1U);
  ASSERT_EQ(diagnostics.last().status().size(), 3U);
  EXPECT_EQ(diagnostics.last().status()[0].message(), "driving");
  ASSERT_EQ(tf.last().transforms().size(), 1U);
  EXPECT_EQ(tf.last().transforms()[0].child_frame_id(), "base_link");
  EXPECT_EQ(tf.last().transforms()[0].transform().translation().x(),
            static_cast<double>(cycle.scene.ego.rear_axle.x_m));

  // Who joins now gets the latest plan and map, though nothing is published any more.
  RosNode late(free_domain());
  RosReader<autoware_planning_msgs::msg::Trajectory> late_plan(late, "rt/s4tp/trajectory",
                                                               "autoware_planning_msgs", "Trajectory", true);
  RosReader<visualization_msgs::msg::MarkerArray> late_lanes(late, "rt/s4tp/lanes", "visualization_msgs",
                                                             "MarkerArray", true);
  EXPECT_TRUE(wait_for([&] { return late_plan.count() > 0 && late_lanes.count() > 0; }));
  EXPECT_EQ(seconds(late_plan.last().header().stamp()), start_s);
}

}  // namespace
}  // namespace s4tp
