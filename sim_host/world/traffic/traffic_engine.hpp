#pragma once
/// The traffic around the ego, whoever simulates it: our own drivers (traffic.hpp) or SUMO (sim_host/sumo).

#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim_host/world/scenario/engine.hpp"
#include "sim_host/world/traffic/recording.hpp"
#include "sim_host/world/traffic/traffic_view.hpp"

namespace s4tp::traffic {

inline constexpr double kTick_s = 0.01;  ///< of a step

/// The ego as other drivers see it.
struct EgoSeen {
  CarState car;  ///< where it is
  Actor actor;   ///< the same on the network
};

/// An engine outside this process has ended by itself: a fault of its own.
class EngineEnded : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What a car is about, as its engine knows it.
struct CarFlags {
  int id = 0;
  bool changing_lane = false;
  bool waiting = false;  ///< stands: before a junction, or behind somebody
};

/// Time begins at 0 with an empty network. WORLD-040 The same scenario, seed and egos give the same cars to
/// the bit, whatever else runs.
class TrafficEngine {
 public:
  virtual ~TrafficEngine() = default;

  /// Advances 10 ms. \param ego  as it is before the step, or null: not there
  /// \throws EngineEnded, or std::runtime_error when an engine outside this process has failed otherwise
  virtual void step(const EgoSeen* ego) = 0;
  /// WORLD-023 A copy that goes on by itself: the same egos give it the same cars as the original, to the
  /// bit. \return null where the engine cannot be copied (SUMO: run the same seed again)
  [[nodiscard]] virtual std::unique_ptr<TrafficEngine> clone() const { return nullptr; }
  [[nodiscard]] virtual double time_s() const = 0;
  [[nodiscard]] virtual std::vector<CarState> cars() const = 0;  ///< the ego is not among them
  [[nodiscard]] virtual std::vector<CarFlags> flags() const = 0;
  /// Takes everybody off a stretch of a lane.
  virtual void clear(map::LaneId lane, double from_m, double to_m) = 0;
  [[nodiscard]] virtual int finished() const = 0;  ///< cars that reached the end of their route
  /// The ego driven by the engine's own driver from the mission's entry on; none where we drive it.
  [[nodiscard]] virtual std::optional<CarState> driven_ego() const { return std::nullopt; }
};

/// Who drives the ego from the mission's entry on.
enum class DrivenBy { kNobody, kUs, kEngine };

struct EngineOptions {
  scenario::Engine engine = scenario::Engine::kBuiltin;
  std::uint64_t seed = 0;
  std::uint64_t episode = 0;     ///< chooses among a scenario's own route files
  DrivenBy ego = DrivenBy::kUs;  ///< kEngine: SUMO only
  bool ego_on_any_lane = false;  ///< SUMO: without sumo::EgoCoupling::on_route
};

}  // namespace s4tp::traffic
