#include "sim_host/recording/recorder.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "firmware/wire/codec.hpp"

namespace s4tp::recording {
namespace {

/// So that nothing is begun that cannot be gone on with.
const std::filesystem::path& free_place(const std::filesystem::path& file) {
  if (std::filesystem::exists(note_folder(file))) {
    throw std::runtime_error(note_folder(file).string() +
                             ": is there already, of another recording; name another --record, or remove it");
  }
  return file;
}

}  // namespace

Recorder::Recorder(const std::filesystem::path& file, const SeriesLimits& limits, DriveNote note,
                   const scenario::Scenario& scenario)
    : file_(file), note_(std::move(note)), series_(free_place(file), limits) {
  write_note(note_, scenario, file);
}

void Recorder::write(std::uint64_t time_us, const std::vector<wire::Frame>& frames) {
  const bool tick = std::any_of(frames.begin(), frames.end(),
                                [](const wire::Frame& frame) { return frame.id == wire::kTickId; });
  if (tick) ++ticks_;
  series_.write(time_us, frames, tick);
}

Recorder::~Recorder() {
  if (ticks_ > 0) return;
  std::error_code ignored;
  std::filesystem::remove(file_, ignored);
  std::filesystem::remove_all(note_folder(file_), ignored);
}

bool Recorder::finish() {
  series_.flush();
  note_.ticks = ticks_;
  if (ticks_ > 0) end_note(note_, file_);
  return ticks_ > 0;
}

std::function<void(std::uint64_t, const std::vector<wire::Frame>&)> sink(Recorder& recorder) {
  return [&recorder](std::uint64_t time_us, const std::vector<wire::Frame>& frames) {
    recorder.write(time_us, frames);
  };
}

}  // namespace s4tp::recording
