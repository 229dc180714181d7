#include "hal/sim/bus.hpp"

namespace s4tp::hal::sim {
namespace {

bool usable(CanState state) {
  return state == CanState::kActive || state == CanState::kPassive;
}

}  // namespace

Bus::Port* Bus::attach() {
  if (attached_ == kMaxPorts) return nullptr;
  Port& port = ports_[attached_++];
  port.bus_ = this;
  return &port;
}

bool Bus::Port::receive(CanFrame& frame) {
  if (size_ == 0) return false;
  frame = queue_[first_];
  first_ = (first_ + 1) % kQueueFrames;
  --size_;
  return true;
}

bool Bus::Port::send(const CanFrame& frame) {
  if (!usable(state_)) {
    ++counters_.dropped;
    return false;
  }
  ++counters_.sent;
  CanFrame on_the_way = frame;
  if (bus_->fault != nullptr && !bus_->fault->pass(on_the_way)) return true;
  for (int i = 0; i < bus_->attached_; ++i) {
    if (&bus_->ports_[i] != this) bus_->ports_[i].deliver(on_the_way);
  }
  return true;
}

void Bus::Port::deliver(const CanFrame& frame) {
  if (!usable(state_)) return;
  if (size_ == kQueueFrames) {
    ++counters_.dropped;
    return;
  }
  queue_[(first_ + size_) % kQueueFrames] = frame;
  ++size_;
  ++counters_.received;
  if (listener != nullptr) listener->frame_arrived(frame);
}

}  // namespace s4tp::hal::sim
