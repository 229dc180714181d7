#pragma once
/// The frames of a recording: candump's log format and nothing else, so that every reader of it reads ours,
/// in a series of files FILE, FILE.1, FILE.2, ... of limited size, oldest first.

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "firmware/wire/candump.hpp"

namespace s4tp::recording {

struct SeriesLimits {
  std::uint64_t file_bytes = 256'000'000;  ///< the file that reaches it is the last that grows
  int keep = 0;                            ///< so many files are kept, the newest; 0: all
};

/// Files of a series that are there, in order. FILE may have been removed, as the oldest.
[[nodiscard]] std::vector<std::filesystem::path> files_of(const std::filesystem::path& file);

class SeriesWriter {
 public:
  /// REC-001 A recording that is there is never written over.
  /// \throws std::runtime_error naming the file, here and later
  SeriesWriter(const std::filesystem::path& file, const SeriesLimits& limits);

  /// REC-002 Every file begins with the first frames of a tick. \param begins_tick  these are such
  void write(std::uint64_t time_us, const std::vector<wire::Frame>& frames, bool begins_tick);
  /// Everything is on its way to the disk.
  void flush();

 private:
  void open(const std::filesystem::path& file);
  void check() const;

  std::filesystem::path first_;
  std::filesystem::path current_;
  SeriesLimits limits_;
  std::ofstream stream_;
  std::uint64_t written_bytes_ = 0;
  std::uint64_t flushed_us_ = 0;
  int number_ = 0;
};

/// Where a record stands.
struct Place {
  std::filesystem::path file;
  std::uint64_t line = 0;
  [[nodiscard]] std::string text() const { return file.string() + ":" + std::to_string(line); }
};

/// One line: a frame, or a comment as campaign::BusLog writes them (a "#" first).
struct Record {
  wire::LoggedFrame logged;
  std::string comment;  ///< empty: a frame
  std::uint64_t line = 0;
};

class SeriesReader {
 public:
  /// \throws std::runtime_error when there is no such series
  explicit SeriesReader(const std::filesystem::path& file);

  /// REC-003 Read up to the last good record: a line without an end, one that is no frame of candump's, a
  /// time that steps back, a file missing in between end it. Frames of other kinds (29 bits, FD, remote) are
  /// passed over. \return false at the end
  [[nodiscard]] bool next(Record& record);
  /// File, line and what was wrong with it; empty: nothing.
  [[nodiscard]] const std::string& damage() const { return damage_; }
  /// REC-004 The oldest files were not kept, or are lost: the ECU's state at the beginning is unknown.
  [[nodiscard]] bool begins_later() const { return begins_later_; }
  [[nodiscard]] Place place() const { return {files_[file_], line_}; }
  [[nodiscard]] std::uint64_t passed_over() const { return passed_over_; }

 private:
  bool next_file();
  bool fail(const std::string& what);

  std::vector<std::filesystem::path> files_;
  std::size_t file_ = 0;
  std::ifstream stream_;
  std::uint64_t line_ = 0;
  std::uint64_t time_us_ = 0;
  std::uint64_t passed_over_ = 0;
  std::string damage_;
  bool begins_later_ = false;
};

}  // namespace s4tp::recording
