#pragma once
/// A recording from its beginning to its last good record, through an ECU, and for a page through its world:
/// `replay FILE`.

#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <ostream>
#include <string>

#include "sim_host/campaign/cell.hpp"
#include "sim_host/campaign/trace.hpp"
#include "sim_host/recording/as_seen.hpp"
#include "sim_host/recording/drive_note.hpp"
#include "sim_host/recording/rerun.hpp"
#include "sim_host/recording/ticks.hpp"

namespace s4tp::recording {

struct PlaybackOptions {
  std::filesystem::path file;
  DriveNote without_note;                                    ///< who drove, where no note says it
  double from_s = -std::numeric_limits<double>::infinity();  ///< judged, and shown, from then on
  bool page = false;                                         ///< write_page() follows
};

/// Times are those of the page: 0 is when the ECU takes over, or where a log begins that has no note.
class Playback {
 public:
  static constexpr int kIdentical = 0;
  static constexpr int kDifferent = 1;
  static constexpr int kNotJudged = 2;

  /// \throws std::runtime_error when there is no such recording, or it was driven with other parameters, by
  /// another planner, with another wire version
  explicit Playback(PlaybackOptions options);

  void run();
  /// What came of it, in words. \return kIdentical, kDifferent or kNotJudged
  [[nodiscard]] int report(std::ostream& out) const;
  /// REC-041 The world's own view where it is known and comes out again to the bit, else the ECU's.
  /// \throws std::runtime_error when there is nothing to show, or the file cannot be written
  void write_page(const std::filesystem::path& file, std::ostream& out);

  [[nodiscard]] const DriveNote& note() const { return note_; }

 private:
  void look();
  [[nodiscard]] std::string reason_not_to_judge() const;
  [[nodiscard]] std::string command(const campaign::EpisodeRow& row) const;
  [[nodiscard]] double shown_from_s() const;
  [[nodiscard]] double seconds_of(std::uint64_t tick) const;
  [[nodiscard]] std::string told(const Agreement& agreement) const;

  PlaybackOptions options_;
  TickReader reader_;
  bool noted_;
  RecordedTick tick_;
  bool more_ = false;
  DriveNote note_;
  std::unique_ptr<campaign::Trace> trace_ = std::make_unique<campaign::Trace>();
  std::size_t kept_cycles_ = 0;
  std::optional<EcuRerun> ecu_;
  std::optional<scenario::Scenario> scenario_;
  std::optional<WorldRerun> world_;
  AsSeen seen_;
  Agreement judged_;
  Agreement before_;
  std::uint64_t ticks_ = 0;
};

}  // namespace s4tp::recording
