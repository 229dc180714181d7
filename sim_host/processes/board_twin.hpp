#pragma once
/// What a board tells that has no shared memory of ours: an ECU of this machine hears the same frames, and as
/// the same frames give the same plans to the bit, what it tells is what the board does.

#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "algo/core/parameters.hpp"
#include "firmware/wire/frame.hpp"
#include "sim_host/campaign/driver.hpp"
#include "sim_host/telemetry/ecu_tap.hpp"

namespace s4tp::processes {

/// The ECU that the twin is one of.
struct TwinOf {
  std::string board;  ///< where it is, for whoever looks
  std::string planner = "s4tp";
  bool guarded = true;
  Parameters parameters{};
  const hal::FlashBank* weights = nullptr;  ///< as the board's; must outlive the twin
};

class BoardTwin {
 public:
  /// Without shared memory it says why, and does nothing.
  /// \param memory  its name; empty: nothing is told  \param out  must outlive it
  BoardTwin(const std::string& memory, const TwinOf& of, std::ostream& out);

  /// TELE-006 Frames of the bus as WorldProcessOptions::record gives them: a tick's from the world at once,
  /// those of the board one by one. A board that sends anything else than the twin does is not shown any
  /// longer, and the first difference is told.
  void hear(const std::vector<wire::Frame>& frames);
  [[nodiscard]] bool tells() const { return driver_ != nullptr; }

 private:
  [[nodiscard]] bool agrees() const;
  void give_up();

  telemetry::EcuTap tap_;
  std::unique_ptr<campaign::Driver> driver_;  ///< null: nothing is told
  std::vector<wire::Frame> twins_;            ///< of the tick before
  std::vector<wire::Frame> boards_;
  std::ostream& out_;
};

}  // namespace s4tp::processes
