// What an ECU process tells through shared memory, as DDS topics: s4tp-telemetry [--ecu /NAME]
// With --input also the way back: objects and map from topics, as frames for the ECU.
// Exit codes: 0 told to stop, 2 wrong use or no DDS.

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <iostream>
#include <memory>
#include <string>
#include <thread>

#include "sim_host/processes/bus_end.hpp"
#include "sim_host/processes/stop_signals.hpp"
#include "sim_host/telemetry/dds_input.hpp"
#include "sim_host/telemetry/dds_publisher.hpp"

namespace {

/// The input topics and the link to the ECU.
class Input {
 public:
  Input(dds_entity_t participant, const std::string& link)
      : name_(link), topics_(std::make_unique<s4tp::telemetry::DdsInput>(participant, std::cerr)) {
    s4tp::processes::open_bus(*link_, link, s4tp::processes::Side::kWorld);
  }
  void pass_on() {
    using s4tp::telemetry::DdsInput;
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    const auto now_ms =
        static_cast<std::uint32_t>(std::chrono::duration_cast<std::chrono::milliseconds>(now).count());
    (void)link_->can().wait(0);
    topics_->look(now_ms);
    if (now_ms / DdsInput::kPeriodMs != period_) topics_->send(now_ms, link_->can());
    period_ = now_ms / DdsInput::kPeriodMs;
    s4tp::hal::CanFrame answer;
    for (int i = 0; i < kMostAnswers && link_->can().receive(answer); ++i) {
    }
    s4tp::processes::print_news(std::cout, name_, link_->can());
  }
  [[nodiscard]] const s4tp::telemetry::InputReport& report() const { return topics_->report(); }
  void print() const {
    for (const auto* counts : {&report().objects, &report().maps}) {
      std::cout << (counts == &report().objects ? "object lists: " : "maps: ") << counts->taken()
                << " taken, " << counts->refused() << " refused\n";
    }
    s4tp::processes::print_counters(std::cout, name_, link_->can().counters());
  }

 private:
  static constexpr int kMostAnswers = 256;
  std::string name_;
  std::unique_ptr<s4tp::hal::linux_host::NamedBus> link_ =
      std::make_unique<s4tp::hal::linux_host::NamedBus>();
  std::unique_ptr<s4tp::telemetry::DdsInput> topics_;
  std::uint32_t period_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  using namespace s4tp;
  constexpr useconds_t kLook_us = 2000;
  std::string ecu = telemetry::kDefaultName;
  std::uint32_t domain = 0;
  std::string interface_name;
  std::string link;
  CLI::App app{"a running ECU as DDS topics (docs/telemetry.md)"};
  app.add_option("--ecu", ecu, "its shared memory (default /s4tp_ecu)");
  app.add_option("--domain", domain, "DDS domain, as ROS_DOMAIN_ID (default 0)")->check(CLI::Range(0, 232));
  app.add_option("--interface", interface_name, "network interface to speak on (default lo, nobody else)");
  app.add_option(
      "--input", link,
      "bus to send objects and map to, as told on /s4tp/input/.. (the ECU's --input; default none)");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    const std::atomic<bool>& stop = processes::stop_on_signals();
    telemetry::DdsPublisher publisher(domain, interface_name);
    std::unique_ptr<Input> input;
    if (!link.empty()) input = std::make_unique<Input>(publisher.participant(), link);
    std::jthread commands([&](const std::stop_token& over) {
      telemetry::Watch watch(ecu);
      for (; !over.stop_requested(); usleep(kLook_us)) {
        if (watch.look().control) publisher.publish(watch.control());
      }
    });
    telemetry::Watch watch(ecu);
    std::string said;
    while (!stop) {
      const telemetry::News news = watch.look();
      const int process = watch.writer();
      const std::string state =
          !watch.present() ? "no ECU: " + watch.absence()
          : process == 0   ? "the ECU has ended"
                           : "ECU of process " + std::to_string(process) + " on " + watch.identity().bus;
      if (state != said) std::cout << (said = state) << std::endl;
      if (input) input->pass_on();
      publisher.publish(watch, news, input ? &input->report() : nullptr);
      usleep(kLook_us);
    }
    commands.request_stop();
    commands.join();
    for (int i = 0; i < telemetry::kTopicCount; ++i) {
      const auto topic = static_cast<telemetry::Topic>(i);
      std::cout << publisher.written(topic) << " x " << publisher.name(topic) << '\n';
    }
    if (input) input->print();
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "s4tp-telemetry: " << error.what() << '\n';
    return 2;
  }
}
