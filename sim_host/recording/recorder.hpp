#pragma once
/// Records a drive: `run --record FILE`.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "sim_host/recording/drive_note.hpp"
#include "sim_host/recording/series.hpp"

namespace s4tp::recording {

class Recorder {
 public:
  /// \throws std::runtime_error naming the file, here and later
  Recorder(const std::filesystem::path& file, const SeriesLimits& limits, DriveNote note,
           const scenario::Scenario& scenario);
  /// REC-006 Of a drive that never began nothing stays.
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  void write(std::uint64_t time_us, const std::vector<wire::Frame>& frames);
  /// The drive has come to its end. \return whether there was one
  bool finish();

 private:
  std::filesystem::path file_;
  DriveNote note_;
  SeriesWriter series_;
  std::uint64_t ticks_ = 0;
};

/// As an episode's or a world process's options take it. \param recorder  must outlive it
[[nodiscard]] std::function<void(std::uint64_t, const std::vector<wire::Frame>&)> sink(Recorder& recorder);

}  // namespace s4tp::recording
