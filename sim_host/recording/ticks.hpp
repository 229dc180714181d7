#pragma once
/// A recording tick by tick: what the ECU heard up to a TICK frame, then what it answered.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "firmware/wire/frame.hpp"
#include "sim_host/recording/series.hpp"

namespace s4tp::recording {

struct RecordedTick {
  std::uint64_t number = 0;             ///< from 0
  std::uint64_t time_us = 0;            ///< of its TICK frame, since the first of them
  std::vector<wire::Frame> from_world;  ///< TICK last
  std::vector<wire::Frame> from_ecu;
  int misses = 0;                    ///< deadlines of the planning cycle that were missed ("# miss")
  Place place;                       ///< of its first frame
  std::vector<std::uint64_t> lines;  ///< of from_ecu, in the file of `place` or the one after
};

/// Whether the DBC says that the ECU sends it.
[[nodiscard]] bool sent_by_ecu(const wire::Frame& frame);
/// "Command 020#0102030405060708"
[[nodiscard]] std::string words(const wire::Frame& frame);
/// REC-023 To the bit; of CycleStatistics what a cycle cost is left out, as it is the processor's and not the
/// drive's.
[[nodiscard]] bool same(const wire::Frame& a, const wire::Frame& b);

class TickReader {
 public:
  /// \throws std::runtime_error when there is no such series
  explicit TickReader(const std::filesystem::path& file) : series_(file) {}

  /// REC-005 A tick is given when the next one has begun, or the file has ended well: of one that was cut off
  /// nobody knows what is missing. \return false at the end
  [[nodiscard]] bool next(RecordedTick& tick);
  [[nodiscard]] const SeriesReader& series() const { return series_; }
  /// Time of the first TICK frame as the file has it; 0 before that is read.
  [[nodiscard]] std::uint64_t begin_us() const { return begin_us_.value_or(0); }
  /// What campaign::BusLog says of the drive in its first line; empty: nothing so far.
  [[nodiscard]] const std::string& header() const { return header_; }

 private:
  SeriesReader series_;
  RecordedTick pending_;
  bool ticked_ = false;  ///< pending_ has its TICK
  bool ended_ = false;
  std::optional<std::uint64_t> begin_us_;
  std::uint64_t ticks_ = 0;
  std::string header_;
};

}  // namespace s4tp::recording
