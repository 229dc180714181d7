#pragma once
/// The other end of the bus: vehicle, perception, map node and traffic, known to the ECU by frames only.

#include <cstdint>
#include <memory>
#include <vector>

#include "firmware/wire/frame.hpp"
#include "sim_host/world/recording.hpp"
#include "sim_host/world/scenario.hpp"

namespace s4tp::world {

struct WorldOptions {
  std::uint64_t seed = 0;
  double pre_roll_s = 3.0;
};

class World {
 public:
  World(const Scenario& scenario, const WorldOptions& options);
  ~World();

  /// Advances 10 ms and appends this tick's frames, the TICK frame last.
  void tick(std::vector<wire::Frame>& frames);
  /// A frame from the ECU: taken only if its protection is right; it acts from the next tick on.
  void receive(const wire::Frame& frame);

  [[nodiscard]] bool finished() const;
  [[nodiscard]] double time_s() const;  ///< since the ECU took over
  [[nodiscard]] const Recording& recording() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace s4tp::world
