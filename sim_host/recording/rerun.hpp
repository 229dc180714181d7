#pragma once
/// Recorded ticks once more: into an ECU, and through the world they came from.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "sim_host/campaign/driver.hpp"
#include "sim_host/campaign/trace.hpp"
#include "sim_host/recording/drive_note.hpp"
#include "sim_host/recording/ticks.hpp"
#include "sim_host/world/world.hpp"

namespace s4tp::recording {

/// How frames compare with those recorded.
struct Agreement {
  std::uint64_t compared = 0;
  std::uint64_t differing = 0;
  std::string first;  ///< REC-020 the first difference: tick, file and line, both frames, the bytes
  std::uint64_t first_tick = 0;  ///< RecordedTick::number of it

  /// \param lines  of the recorded ones, in the file of the tick's place; may be empty
  void compare(const RecordedTick& tick, const std::vector<wire::Frame>& recorded,
               const std::vector<wire::Frame>& now, const std::vector<std::uint64_t>& lines);
};

/// An ECU as the one of the drive, from its start.
class EcuRerun {
 public:
  /// \param trace  may be null  \throws as campaign::make_driver()
  EcuRerun(const DriveNote& note, campaign::Trace* trace);
  /// REC-021 What it hears is what was recorded, whatever it answers.
  void play(const RecordedTick& tick, Agreement& agreement);
  [[nodiscard]] const ecu::EcuCore& core() const { return driver_->core(); }

 private:
  std::unique_ptr<campaign::Driver> driver_;
  std::vector<wire::Frame> answers_;
};

/// The drive's world, whose vehicle does what it was told then.
class WorldRerun {
 public:
  /// \param scenario  must outlive it  \throws std::runtime_error when the traffic cannot be started
  WorldRerun(const DriveNote& note, const scenario::Scenario& scenario);
  /// REC-022 The recording shows this world as long as all its frames agree.
  void play(const RecordedTick& tick);
  [[nodiscard]] const Agreement& agreement() const { return agreement_; }
  [[nodiscard]] const world::World& world() const { return world_; }
  /// What reached the vehicle in each tick.
  [[nodiscard]] const std::vector<std::vector<wire::Frame>>& commands() const { return commands_; }

 private:
  [[nodiscard]] bool reached_vehicle(const wire::Frame& frame, std::uint64_t tick);

  Meeting meeting_;
  world::World world_;
  Agreement agreement_;
  std::vector<std::vector<wire::Frame>> commands_;
  std::vector<wire::Frame> frames_;
  bool answered_ = false;
};

}  // namespace s4tp::recording
