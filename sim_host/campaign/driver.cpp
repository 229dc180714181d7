#include "sim_host/campaign/driver.hpp"

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "firmware/ecu/ecu.hpp"
#include "hal/sim/bus.hpp"
#include "hal/sim/null_devices.hpp"
#include "hal/sim/sim_clock.hpp"
#include "sim_host/baselines/blind.hpp"
#include "sim_host/baselines/constant_speed.hpp"

namespace s4tp::campaign {
namespace {

hal::CanFrame to_hal(const wire::Frame& frame) {
  hal::CanFrame can;
  can.id = frame.id;
  can.length = frame.length;
  std::memcpy(can.data, frame.data, sizeof frame.data);
  return can;
}

wire::Frame to_wire(const hal::CanFrame& can) {
  wire::Frame frame;
  frame.id = can.id;
  frame.length = std::min<std::uint8_t>(can.length, sizeof frame.data);
  std::memcpy(frame.data, can.data, sizeof frame.data);
  return frame;
}

void set_probe(Planner& planner, Probe* probe) {
  planner.probe = probe;
}
void set_probe(baselines::BlindPlanner& planner, Probe* probe) {
  planner.inner().probe = probe;
}
void set_probe(baselines::ConstantSpeedPlanner&, Probe*) {}

template <typename PlannerT>
class EcuDriver final : public Driver {
 public:
  EcuDriver(const Parameters& parameters, hal::Telemetry* telemetry, Probe* probe) {
    const ecu::Ports ports{ecu_port_, &clock_, &cycles_, &watchdog_, telemetry};
    if (const Status status = ecu_.init(parameters, ports); status != Status::kOk) {
      throw std::invalid_argument(std::string("the ECU refused to start: ") + status_name(status));
    }
    set_probe(ecu_.planner(), probe);
  }

  void tick(const std::vector<wire::Frame>& from_world, std::vector<wire::Frame>& to_world) override {
    for (const wire::Frame& frame : from_world) {
      if (!world_port_->send(to_hal(frame))) throw std::logic_error("the in-process bus refused a frame");
    }
    clock_.follow(time_ms_ += kTickMs);
    ecu_.control_tick();
    if (ecu_.planning_due()) ecu_.planning_cycle();
    hal::CanFrame frame;
    while (world_port_->receive(frame)) to_world.push_back(to_wire(frame));
  }

  void inject_deadline_miss() override { ecu_.inject_deadline_miss(); }
  ecu::Mode mode() const override { return ecu_.mode(); }

 private:
  static constexpr std::uint32_t kTickMs = 10;

  hal::sim::Bus bus_;
  hal::sim::Bus::Port* world_port_ = bus_.attach();
  hal::sim::Bus::Port* ecu_port_ = bus_.attach();
  hal::sim::SimClock clock_;
  hal::sim::NullCycleCounter cycles_;
  hal::sim::NullWatchdog watchdog_;
  std::uint32_t time_ms_ = 0;
  ecu::Ecu<PlannerT> ecu_;
};

using Factory = std::unique_ptr<Driver> (*)(const Parameters&, hal::Telemetry*, Probe*);

template <typename PlannerT>
std::unique_ptr<Driver> make(const Parameters& parameters, hal::Telemetry* telemetry, Probe* probe) {
  return std::make_unique<EcuDriver<PlannerT>>(parameters, telemetry, probe);
}

const std::vector<std::pair<std::string, Factory>> kPlanners{
    {"s4tp", make<Planner>},
    {"constant_speed", make<baselines::ConstantSpeedPlanner>},
    {"blind", make<baselines::BlindPlanner>},
};

}  // namespace

const std::vector<std::string>& planner_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const auto& [name, factory] : kPlanners) all.push_back(name);
    return all;
  }();
  return names;
}

std::unique_ptr<Driver> make_driver(const std::string& planner, const Parameters& parameters,
                                    hal::Telemetry* telemetry, Probe* probe) {
  for (const auto& [name, factory] : kPlanners) {
    if (name == planner) return factory(parameters, telemetry, probe);
  }
  std::string known;
  for (const std::string& name : planner_names()) known += (known.empty() ? "" : ", ") + name;
  throw std::invalid_argument("no planner '" + planner + "'; there are: " + known);
}

}  // namespace s4tp::campaign
