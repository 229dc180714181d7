// A subscriber of another vendor, Fast DDS, that prints the plan of a running ECU once a second and why: print_plan
// [DOMAIN [SECONDS]]. Exit code: 0 a plan came, 1 none.
#include <ros.h>

#include <chrono>
#include <cstdlib>
#include <functional>
#include <iomanip>
#include <iostream>
#include <string>
#include <thread>

#include "tests/dds/ros_reader.hpp"

int main(int argc, char** argv) {
  using namespace std::chrono_literals;
  using s4tp::tests::RosReader;
  s4tp::tests::RosNode node(argc > 1 ? static_cast<std::uint32_t>(std::atoi(argv[1])) : 0U);
  RosReader<autoware_planning_msgs::msg::Trajectory> plan(node, "rt/s4tp/trajectory",
                                                          "autoware_planning_msgs", "Trajectory", true);
  RosReader<std_msgs::msg::String> words(node, "rt/s4tp/explanation", "std_msgs", "String", true);
  const auto end =
      std::chrono::steady_clock::now() + std::chrono::seconds(argc > 2 ? std::atoi(argv[2]) : 60);
  std::cout << std::fixed;
  for (double said_s = -1.0; std::chrono::steady_clock::now() < end; std::this_thread::sleep_for(10ms)) {
    const auto message = plan.last();
    const double start_s = message.header().stamp().sec() + 1e-9 * message.header().stamp().nanosec();
    if (message.points().empty() || (start_s >= said_s && start_s < said_s + 1.0)) continue;
    said_s = start_s;
    const auto& first = message.points().front();
    const auto& last = message.points().back();
    std::cout << std::setprecision(1) << start_s << " s: " << message.points().size() << " points, from "
              << first.longitudinal_velocity_mps() << " m/s at (" << first.pose().position().x() << ", "
              << first.pose().position().y() << ") to " << last.longitudinal_velocity_mps() << " m/s at ("
              << last.pose().position().x() << ", " << last.pose().position().y() << "). "
              << words.last().data().substr(0, words.last().data().find('\n')) << std::endl;
  }
  return plan.count() > 0 ? 0 : 1;
}
