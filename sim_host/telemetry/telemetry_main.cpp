// What an ECU process tells through shared memory, as DDS topics: s4tp-telemetry [--ecu /NAME]
// Exit codes: 0 told to stop, 2 wrong use or no DDS.

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <string>

#include "sim_host/processes/stop_signals.hpp"
#include "sim_host/telemetry/dds_publisher.hpp"

int main(int argc, char** argv) {
  using namespace s4tp;
  constexpr useconds_t kLook_us = 2000;
  std::string ecu = telemetry::kDefaultName;
  std::uint32_t domain = 0;
  std::string interface_name;
  CLI::App app{"a running ECU as DDS topics (docs/telemetry.md)"};
  app.add_option("--ecu", ecu, "its shared memory (default /s4tp_ecu)");
  app.add_option("--domain", domain, "DDS domain, as ROS_DOMAIN_ID (default 0)")->check(CLI::Range(0, 232));
  app.add_option("--interface", interface_name, "network interface to speak on (default lo, nobody else)");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    const std::atomic<bool>& stop = processes::stop_on_signals();
    telemetry::DdsPublisher publisher(domain, interface_name);
    telemetry::Watch watch(ecu);
    std::string said;
    while (!stop) {
      const telemetry::News news = watch.look();
      const std::string state =
          watch.present() ? "ECU of process " + std::to_string(watch.writer()) + " on " + watch.identity().bus
                          : "no ECU: " + watch.absence();
      if (state != said) std::cout << (said = state) << std::endl;
      publisher.publish(watch, news);
      usleep(kLook_us);
    }
    for (int i = 0; i < telemetry::kTopicCount; ++i) {
      const auto topic = static_cast<telemetry::Topic>(i);
      std::cout << publisher.written(topic) << " x " << publisher.name(topic) << '\n';
    }
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "s4tp-telemetry: " << error.what() << '\n';
    return 2;
  }
}
