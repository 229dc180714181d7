#include "sim_host/campaign/driver.hpp"

#include <stdexcept>

#include "firmware/can/frames.hpp"
#include "hal/sim/bus.hpp"
#include "hal/sim/null_devices.hpp"

namespace s4tp::campaign {
namespace {

class EcuOnBus final : public Driver {
 public:
  EcuOnBus(const std::string& planner, bool guarded, const Parameters& parameters, hal::Telemetry* telemetry,
           planner::Probe* probe, const hal::FlashBank* weights)
      : ecu_(baselines::make_ecu(planner, guarded, parameters,
                                 {ecu_port_, &cycles_, &watchdog_, telemetry, weights}, probe)) {}

  void tick(const std::vector<wire::Frame>& from_world, std::vector<wire::Frame>& to_world) override {
    for (const wire::Frame& frame : from_world) {
      if (!world_port_->send(to_hal(frame))) throw std::logic_error("the in-process bus refused a frame");
    }
    ecu_->control_tick();
    if (ecu_->planning_due()) ecu_->planning_cycle();
    hal::CanFrame frame;
    while (world_port_->receive(frame)) to_world.push_back(to_wire(frame));
  }

  void inject_deadline_miss() override { ecu_->inject_deadline_miss(); }
  const ecu::EcuCore& core() const override { return ecu_->core(); }
  const hal::Can& bus() const override { return *ecu_port_; }

 private:
  hal::sim::Bus bus_;
  hal::sim::Bus::Port* world_port_ = bus_.attach();
  hal::sim::Bus::Port* ecu_port_ = bus_.attach();
  hal::sim::NullCycleCounter cycles_;
  hal::sim::NullWatchdog watchdog_;
  std::unique_ptr<baselines::AnyEcu> ecu_;
};

}  // namespace

std::unique_ptr<Driver> make_driver(const std::string& planner, bool guarded, const Parameters& parameters,
                                    hal::Telemetry* telemetry, planner::Probe* probe,
                                    const hal::FlashBank* weights) {
  return std::make_unique<EcuOnBus>(planner, guarded, parameters, telemetry, probe, weights);
}

}  // namespace s4tp::campaign
