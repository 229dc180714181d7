#include "sim_host/world/branch.hpp"

#include <utility>

#include "sim_host/world/traffic/box.hpp"

namespace s4tp::world {
namespace {

constexpr int kMillisecondsPerTick = 10;

}  // namespace

Branch::Branch(Start start, EgoDriver& driver) : start_(std::move(start)), driver_(driver) {
  look();
}

void Branch::look() {
  ego_ = ego_state(start_.vehicle, start_.place);
  others_ = start_.traffic->cars();
  for (const traffic::CarState& car : others_) {
    if (touched_ == traffic::kNoCar && traffic::overlap(traffic::box_of(ego_), traffic::box_of(car)))
      touched_ = car.id;
  }
}

void Branch::step() {  // in the order of World::tick()
  const EgoCommand command = driver_.drive(*this);
  const traffic::EgoSeen self{ego_, start_.road->locator.actor(ego_, start_.place)};
  start_.traffic->step(&self);
  for (int i = 0; i < kMillisecondsPerTick; ++i) {
    start_.vehicle.step(command.acceleration_mps2, command.steering_rad);
  }
  start_.place = start_.road->locator.locate(start_.vehicle.box_centre(), start_.vehicle.heading_rad(),
                                             start_.place.lane);
  ++ticks_;
  look();
}

double Branch::time_s() const {
  return start_.time_s + ticks_ * traffic::kTick_s;
}

}  // namespace s4tp::world
