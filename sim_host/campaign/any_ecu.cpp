#include "sim_host/campaign/any_ecu.hpp"

#include <stdexcept>
#include <utility>

#include "firmware/ecu/ecu.hpp"
#include "sim_host/baselines/blind.hpp"
#include "sim_host/baselines/constant_speed.hpp"

namespace s4tp::campaign {
namespace {

void set_probe(Planner& planner, Probe* probe) {
  planner.probe = probe;
}
void set_probe(baselines::BlindPlanner& planner, Probe* probe) {
  planner.inner().probe = probe;
}
void set_probe(baselines::ConstantSpeedPlanner&, Probe*) {}

template <typename PlannerT>
class EcuWith final : public AnyEcu {
 public:
  EcuWith(const Parameters& parameters, const ecu::Ports& ports, Probe* probe) {
    if (const Status status = ecu_.init(parameters, ports); status != Status::kOk) {
      throw std::invalid_argument(std::string("the ECU refused to start: ") + status_name(status));
    }
    set_probe(ecu_.planner(), probe);
  }
  void control_tick() override { ecu_.control_tick(); }
  bool planning_due() const override { return ecu_.planning_due(); }
  void planning_cycle() override { ecu_.planning_cycle(); }
  void inject_deadline_miss() override { ecu_.inject_deadline_miss(); }
  const ecu::EcuCore& core() const override { return ecu_.core(); }

 private:
  ecu::Ecu<PlannerT> ecu_;
};

using Factory = std::unique_ptr<AnyEcu> (*)(const Parameters&, const ecu::Ports&, Probe*);

template <typename PlannerT>
std::unique_ptr<AnyEcu> make(const Parameters& parameters, const ecu::Ports& ports, Probe* probe) {
  return std::make_unique<EcuWith<PlannerT>>(parameters, ports, probe);
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

std::unique_ptr<AnyEcu> make_ecu(const std::string& planner, const Parameters& parameters,
                                 const ecu::Ports& ports, Probe* probe) {
  for (const auto& [name, factory] : kPlanners) {
    if (name == planner) return factory(parameters, ports, probe);
  }
  std::string known;
  for (const std::string& name : planner_names()) known += (known.empty() ? "" : ", ") + name;
  throw std::invalid_argument("no planner '" + planner + "'; there are: " + known);
}

}  // namespace s4tp::campaign
