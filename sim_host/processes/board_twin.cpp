#include "sim_host/processes/board_twin.hpp"

#include <algorithm>
#include <iomanip>

#include "sim_host/recording/ticks.hpp"

namespace s4tp::processes {

BoardTwin::BoardTwin(const std::string& memory, const TwinOf& of, std::ostream& out) : out_(out) {
  if (memory.empty()) return;
  hal::linux_host::Reason reason;
  if (!tap_.open(memory, of.planner, of.board + ", by a twin that hears the same frames", of.parameters,
                 reason)) {
    out_ << "no telemetry: " << reason.text << std::endl;
    return;
  }
  driver_ = campaign::make_driver(of.planner, of.guarded, of.parameters, &tap_, &tap_, of.weights);
}

void BoardTwin::hear(const std::vector<wire::Frame>& frames) {
  if (driver_ == nullptr || frames.empty()) return;
  if (recording::sent_by_ecu(frames.front())) {
    boards_.insert(boards_.end(), frames.begin(), frames.end());
    return;
  }
  if (!agrees()) return give_up();
  boards_.clear();
  twins_.clear();
  driver_->tick(frames, twins_);
  tap_.note_status(driver_->core(), driver_->bus());
}

bool BoardTwin::agrees() const {
  return std::equal(twins_.begin(), twins_.end(), boards_.begin(), boards_.end(), recording::same);
}

void BoardTwin::give_up() {
  const auto [twin, board] =
      std::mismatch(twins_.begin(), twins_.end(), boards_.begin(), boards_.end(), recording::same);
  out_ << "not shown any longer: in the tick of " << std::fixed << std::setprecision(2)
       << driver_->core().now_ms() / 1000.0 << std::defaultfloat << " s the board sent "
       << (board == boards_.end() ? "nothing" : recording::words(*board)) << " and its twin "
       << (twin == twins_.end() ? "nothing" : recording::words(*twin)) << std::endl;
  driver_.reset();
  tap_.close();
}

}  // namespace s4tp::processes
