#include "sim_host/recording/playback.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <utility>

#include "algo/core/versions.hpp"
#include "sim_host/metrics/metrics.hpp"
#include "sim_host/view/html.hpp"
#include "sim_host/view/replay.hpp"

namespace s4tp::recording {
namespace {

namespace fs = std::filesystem;
using view::format;

constexpr double kTick_s = 0.01;
constexpr double kPage_s = 900.0;        // of a log without a known end: more is no page any more
constexpr double kBeforeShown_s = 10.0;  // what led to it

/// The number after a word of a log's first line; -1: none.
long number_after(const std::string& header, const std::string& word) {
  const std::size_t at = header.find(word);
  return at == std::string::npos ? -1 : std::atol(header.c_str() + at + word.size());
}

/// Who drove, where no note says it: as the options have it, if the log's own first line does not contradict.
DriveNote note_of_log(const std::string& header, const PlaybackOptions& options) {
  const DriveNote& note = options.without_note;
  const long crc = number_after(header, ", parameters ");
  if (crc >= 0 && static_cast<std::uint32_t>(crc) != parameters_crc(note.parameters)) {
    throw std::runtime_error(options.file.string() +
                             ": driven with other parameters; name their file: --parameters FILE");
  }
  if (const std::size_t at = header.find(", planner "); at != std::string::npos) {
    const std::string who = header.substr(at + 10, header.find(',', at + 10) - at - 10);
    const std::string as_asked = note.planner + (note.guarded ? "" : " bare");
    if (who != as_asked) {
      throw std::runtime_error(options.file.string() + ": driven by " + who + ", not " + as_asked +
                               "; --planner and --guard name it");
    }
  }
  const long wire = number_after(header, "wire ");
  if (wire >= 0 && wire != int{kWireVersion}) {
    throw std::runtime_error(options.file.string() + ": recorded with wire version " + std::to_string(wire) +
                             "; this program's is " + std::to_string(int{kWireVersion}));
  }
  return note;
}

}  // namespace

Playback::Playback(PlaybackOptions options)
    : options_(std::move(options)), reader_(options_.file), noted_(has_note(options_.file)) {
  more_ = reader_.next(tick_);
  note_ = noted_ ? read_note(options_.file) : note_of_log(reader_.header(), options_);
  if (note_.planner.empty()) note_.planner = options_.without_note.planner;
  ecu_.emplace(note_, options_.page ? trace_.get() : nullptr);
  if (options_.page && noted_ && !reader_.series().begins_later()) {
    scenario_.emplace(scenario_of(options_.file));
    world_.emplace(note_, *scenario_);
  }
}

void Playback::run() {
  for (; more_; more_ = reader_.next(tick_)) {
    ++ticks_;
    const bool judged = seconds_of(tick_.number) >= options_.from_s - 0.5 * kTick_s;
    ecu_->play(tick_, judged ? judged_ : before_);
    if (world_) world_->play(tick_);
    if (options_.page) look();
  }
}

/// A drive of our world ends; of anything longer a stretch is shown.
void Playback::look() {
  const double now_s = seconds_of(tick_.number);
  const bool shown = world_ || (now_s >= shown_from_s() && now_s < shown_from_s() + kPage_s);
  trace_->controls.clear();
  if (!shown) {
    trace_->cycles.resize(kept_cycles_);
    return;
  }
  kept_cycles_ = trace_->cycles.size();
  seen_.look(ecu_->core(), note_.parameters, now_s);
}

int Playback::report(std::ostream& out) const {
  const auto& series = reader_.series();
  out << options_.file.string() << ": " << ticks_ << " ticks, "
      << (ticks_ > 0 ? format("%.2f to %.2f s", seconds_of(0), seconds_of(ticks_ - 1)) : "0 s") << "; "
      << judged_.compared << " of the ECU's frames compared, " << judged_.differing << " differ\n";
  if (before_.differing > 0) {
    out << "before that " << before_.differing << " of " << before_.compared << " differ, first at "
        << told(before_);
  }
  if (judged_.differing > 0) out << "first difference at " << told(judged_);
  if (!series.damage().empty()) out << "read up to the last good record: " << series.damage() << '\n';
  if (series.passed_over() > 0) {
    out << "passed over " << series.passed_over() << " frames of other kinds (29 bits, FD, remote)\n";
  }
  const bool ends_early = noted_ && note_.ticks > ticks_;
  if (ends_early) {
    out << "it ends early: the drive had " << note_.ticks << " ticks\n";
  } else if (noted_ && note_.ticks == 0) {
    out << "the drive was not recorded to its end\n";
  }
  if (noted_ && note_.versions != versions_here()) {
    out << "recorded with " << note_.versions << "; this program has " << versions_here() << '\n';
  }
  const std::string reason = reason_not_to_judge();
  if (!reason.empty()) {
    out << "cannot be judged: " << reason << '\n';
    return kNotJudged;
  }
  if (judged_.differing > 0) return kDifferent;
  if (judged_.compared == 0) {
    out << "cannot be judged: no frame of an ECU's"
        << (ticks_ > 0 && options_.from_s > seconds_of(ticks_ - 1) ? " from --from on: it ends before" : "")
        << '\n';
    return kNotJudged;
  }
  const bool whole = series.damage().empty() && !ends_early;
  out << "the same plans and commands, to the bit" << (whole ? "" : ", as far as it goes") << '\n';
  return whole ? kIdentical : kNotJudged;
}

void Playback::write_page(const fs::path& file, std::ostream& out) {
  const bool known = world_ && world_->agreement().differing == 0;
  if (world_ && !known) out << "this program's world is not the recording's: " << told(world_->agreement());
  if (!known && seen_.empty())
    throw std::runtime_error("--view: no pose of ours in " + options_.file.string());
  if (!known) {
    out << "the page shows what the ECU was told of the road and the others"
        << format(", %.0f s at most from %.0f s on\n", kPage_s, shown_from_s());
  }
  const scenario::Scenario& scenario = known ? *scenario_ : seen_.scenario();
  campaign::EpisodeResult result;
  result.recording = known ? world_->world().recording() : seen_.recording();
  if (known) result.origin = world_->world().origin();
  result.trace = std::move(trace_);
  campaign::EpisodeRow row;
  row.cell.planner = note_.planner;
  row.cell.guarded = note_.guarded;
  row.cell.scenario = options_.file.filename().string();
  if (known) {
    row.cell.scenario = note_.scenario;
    row.cell.flavour = note_.flavour;
    row.cell.traffic = note_.traffic;
    row.cell.perception = note_.perception;
  }
  row.metrics = metrics::evaluate(result.recording, scenario);
  view::write_replay({scenario, result, row, command(row), {}}, file);
}

/// What stops a judgement whatever the frames are like.
std::string Playback::reason_not_to_judge() const {
  if (reader_.series().begins_later())
    return "its beginning was not kept, so the ECU's state then is unknown";
  if (note_.meeting == Meeting::kRealTime) {
    return "driven in real time: which tick of the ECU's heard which frame is not on the bus";
  }
  return {};
}

/// Makes the drive again, or the page.
std::string Playback::command(const campaign::EpisodeRow& row) const {
  if (!world_) return "./s4tp replay " + options_.file.string() + " --view";
  const fs::path parameters = note_folder(options_.file) / "parameters.toml";
  return campaign::replay_command(row.cell, scenario_->files.front().string(),
                                  fs::exists(parameters) ? parameters.string() : "", note_.seed);
}

double Playback::shown_from_s() const {
  return std::max(seconds_of(0), options_.from_s - kBeforeShown_s);
}

double Playback::seconds_of(std::uint64_t tick) const {
  return (static_cast<double>(tick + 1) - note_.take_over_tick) * kTick_s;
}

std::string Playback::told(const Agreement& agreement) const {
  return format("%.2f s, ", seconds_of(agreement.first_tick)) + agreement.first + '\n';
}

}  // namespace s4tp::recording
