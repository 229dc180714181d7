#pragma once
/// Frames in, the world as the planner wants it out: protection, freshness, dead reckoning.

#include <cstdint>

#include "algo/core/world_state.hpp"
#include "firmware/ecu/plausibility.hpp"
#include "firmware/ecu/supervision.hpp"
#include "firmware/ecu/vehicle_clock.hpp"
#include "firmware/wire/codec.hpp"
#include "firmware/wire/e2e.hpp"
#include "firmware/wire/lane_map.hpp"
#include "firmware/wire/track_list.hpp"

namespace s4tp::ecu {

/// Notices the periods of a message that stayed empty.
class Silence {
 public:
  explicit Silence(std::uint16_t period_ticks) : period_ticks_(period_ticks) {}
  void heard() { ticks_ = 0; }
  /// Once a tick. \return whether a period has just ended without a frame; half a period is grace for jitter
  [[nodiscard]] bool period_missed();

 private:
  std::uint16_t period_ticks_;
  std::uint16_t ticks_ = 0;
};

/// Protection of one periodic message, told of the periods that stayed empty.
class PeriodicReceiver {
 public:
  explicit PeriodicReceiver(std::uint16_t period_ticks) : silence_(period_ticks) {}
  [[nodiscard]] bool trusts(const wire::Frame& frame);
  void tick();

 private:
  wire::E2eReceiver receiver_;
  Silence silence_;
};

/// All that arrives. Call accept() for each frame of a tick, then close_tick() once.
class Inputs {
 public:
  void accept(const wire::Frame& frame);
  void close_tick();

  [[nodiscard]] std::uint32_t now_ms() const { return clock_.now_ms(); }

  /// ECU-061 Us at now_ms(): each pose is brought forward from its age, and from there on by speed and yaw
  /// rate until the next. ECU-062 Values outside the ranges of world_state.hpp are brought to their bounds.
  [[nodiscard]] const EgoState& ego() const { return ego_; }
  /// Us as told in this tick, for the plausibility monitor.
  [[nodiscard]] const Measured& measured() const { return measured_; }
  [[nodiscard]] bool motion_fresh() const { return motion_missing_ticks_ == 0; }  ///< in this tick
  [[nodiscard]] bool ego_known() const { return motion_seen_ && pose_age_.known(); }

  /// ECU-063 The newest whole list. A list not newer than the one before, from the future or more than 1 s
  /// old is refused. No vehicle is dropped for its numbers: they are brought to their bounds (ECU-062).
  /// How many the list left out goes along.
  [[nodiscard]] const TrackList& tracks() const { return tracks_; }
  [[nodiscard]] std::uint32_t tracks_ms() const { return tracks_ms_; }

  /// The newest whole map, null before the first and when none was confirmed for 5 s.
  [[nodiscard]] const wire::Map* map() const;
  [[nodiscard]] std::uint32_t map_revision() const { return map_revision_; }  ///< counts whole maps

  [[nodiscard]] bool engage_switch() const { return engage_; }
  [[nodiscard]] bool driver_override() const { return driver_override_; }
  [[nodiscard]] bool version_known() const { return version_ == Version::kFits; }
  [[nodiscard]] std::uint16_t tick_number() const { return tick_number_; }

  [[nodiscard]] std::uint32_t accepted_frames() const { return accepted_; }  ///< all taken from the bus
  [[nodiscard]] std::uint32_t rejected_frames() const;  ///< of these, not believed: CRC, counter, range

  /// Fills in what supervision wants to know of the inputs.
  void observe(Observations& observed) const;

 private:
  enum class Version : std::uint8_t { kUnknown, kFits, kDiffers };

  void accept_motion(const wire::Frame& frame);
  void accept_steering(const wire::Frame& frame);
  void accept_pose(const wire::Frame& frame);
  void accept_tracks(const wire::Frame& frame);
  void accept_map(const wire::Frame& frame);
  void accept_version(const wire::Frame& frame);
  void take_tracks();
  void move_ego(std::uint32_t duration_ms);

  VehicleClock clock_;
  PeriodicReceiver motion_receiver_{1};
  PeriodicReceiver steering_receiver_{1};
  PeriodicReceiver pose_receiver_{2};
  PeriodicReceiver tick_receiver_{1};
  PeriodicReceiver version_receiver_{100};
  wire::TrackListReceiver track_receiver_;
  wire::MapReceiver map_receiver_;

  EgoState ego_;
  Measured measured_;
  TrackList tracks_;
  std::uint32_t tracks_ms_ = 0;
  wire::Pose pose_;

  std::uint32_t last_close_ms_ = 0;
  std::uint32_t motion_missing_ticks_ = kNeverMs;
  std::uint32_t motion_mistimed_ticks_ = 0;
  Age pose_age_;
  Age steering_age_;
  Age tracks_age_;
  Age map_age_;  ///< since it was confirmed
  std::uint32_t map_revision_ = 0;
  std::uint32_t accepted_ = 0;
  std::uint32_t rejected_ = 0;
  std::uint16_t tick_number_ = 0;
  Silence list_silence_{10};
  Silence map_silence_{10};
  std::uint8_t map_counter_ = 0xFF;  ///< of the last map header
  Version version_ = Version::kUnknown;
  bool engage_ = false;
  bool driver_override_ = false;

  bool motion_seen_ = false;  ///< ever
  bool motion_new_ = false;   ///< in this tick
  bool pose_new_ = false;
  bool steering_new_ = false;
  bool tracks_new_ = false;
  bool map_confirmed_ = false;
};

}  // namespace s4tp::ecu
