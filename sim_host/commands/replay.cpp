#include "sim_host/view/replay.hpp"

#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <limits>
#include <optional>
#include <stdexcept>

#include "algo/core/versions.hpp"
#include "sim_host/campaign/planner_registry.hpp"
#include "sim_host/campaign/results.hpp"
#include "sim_host/commands/command.hpp"
#include "sim_host/recording/as_seen.hpp"
#include "sim_host/recording/cut.hpp"
#include "sim_host/recording/rerun.hpp"
#include "sim_host/view/html.hpp"

namespace s4tp::commands {
namespace {

namespace fs = std::filesystem;
using recording::DriveNote;
using recording::RecordedTick;
using view::format;

constexpr double kTick_s = 0.01;
constexpr int kIdentical = 0;
constexpr int kDifferent = 1;
constexpr int kNotJudged = 2;

struct ReplayOptions {
  CommonOptions common;
  fs::path file;
  std::string planner = "s4tp";
  std::string guard = "on";
  double from_s = -std::numeric_limits<double>::infinity();
  bool view = false;
  std::optional<double> cut_s;
};

/// What stops a judgement whatever the frames are like.
std::string not_judged(const DriveNote& note, const recording::TickReader& reader) {
  if (reader.series().begins_later()) {
    return "its beginning was not kept, so the ECU's state then is unknown";
  }
  if (note.meeting == recording::Meeting::kRealTime) {
    return "driven in real time: which tick of the ECU's heard which frame is not on the bus";
  }
  return {};
}

/// The number after a word of a log's first line; -1: none.
long number_after(const std::string& header, const std::string& word) {
  const std::size_t at = header.find(word);
  return at == std::string::npos ? -1 : std::atol(header.c_str() + at + word.size());
}

/// Who drove, where no note says it: the log's own first line, then the command's options.
DriveNote note_of_log(const std::string& header, const ReplayOptions& options) {
  DriveNote note;
  note.planner = options.planner;
  note.guarded = options.guard == "on";
  note.parameters = options.common.parameters();
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

/// One pass through a recording.
class Pass {
 public:
  Pass(const ReplayOptions& options, bool through_world)
      : options_(options), reader_(options.file), noted_(recording::has_note(options.file)) {
    more_ = reader_.next(tick_);
    note_ = noted_ ? recording::read_note(options.file) : note_of_log(reader_.header(), options);
    if (note_.planner.empty()) note_.planner = options.planner;
    trace_ = std::make_unique<campaign::Trace>();
    ecu_.emplace(note_, options.view ? trace_.get() : nullptr);
    if (through_world && noted_ && !reader_.series().begins_later()) {
      scenario_.emplace(recording::scenario_of(options.file));
      world_.emplace(note_, *scenario_);
    }
  }

  void run() {
    for (; more_; more_ = reader_.next(tick_)) {
      ++ticks_;
      const bool judged = seconds_of(tick_.number) >= options_.from_s - 0.5 * kTick_s;
      ecu_->play(tick_, judged ? judged_ : before_);
      if (world_) world_->play(tick_);
      if (options_.view) seen_.look(ecu_->core(), note_.parameters, seconds_of(tick_.number));
    }
  }

  /// \return exit code
  int report(std::ostream& out) const {
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
      out << "passed over " << series.passed_over() << " frames that no message of s4tp's can be\n";
    }
    const bool ends_early = noted_ && note_.ticks > ticks_;
    if (ends_early) {
      out << "it ends early: the drive had " << note_.ticks << " ticks\n";
    } else if (noted_ && note_.ticks == 0) {
      out << "the drive was not recorded to its end\n";
    }
    if (noted_ && note_.versions != recording::versions_here()) {
      out << "recorded with " << note_.versions << "; this program has " << recording::versions_here()
          << '\n';
    }
    const std::string reason = not_judged(note_, reader_);
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
    out << "the same plans and commands, to the bit\n";
    return series.damage().empty() && !ends_early ? kIdentical : kNotJudged;
  }

  /// REC-041 The world's own view where it is known and comes out again to the bit, else the ECU's.
  void write_page(const fs::path& file, std::ostream& out) {
    const bool known = world_ && world_->agreement().differing == 0;
    if (world_ && !known) out << "this program's world is not the recording's: " << told(world_->agreement());
    if (!known && seen_.empty())
      throw std::runtime_error("--view: no pose of ours in " + options_.file.string());
    if (!known) out << "the page shows what the ECU was told of the road and the others\n";
    const world::Scenario& scenario = known ? *scenario_ : seen_.scenario();
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

 private:
  /// Makes the drive again, or the page.
  [[nodiscard]] std::string command(const campaign::EpisodeRow& row) const {
    if (!world_) return "./s4tp replay " + options_.file.string() + " --view";
    const fs::path parameters = recording::note_folder(options_.file) / "parameters.toml";
    return campaign::replay_command(row.cell, scenario_->files.front().string(),
                                    fs::exists(parameters) ? parameters.string() : "", note_.seed);
  }

  /// On the page's clock: 0 is when the ECU takes over, or the first tick where nobody noted that.
  [[nodiscard]] double seconds_of(std::uint64_t tick) const {
    return (static_cast<double>(tick + 1) - note_.take_over_tick) * kTick_s;
  }

  [[nodiscard]] std::string told(const recording::Agreement& agreement) const {
    return format("%.2f s, ", seconds_of(agreement.first_tick)) + agreement.first + '\n';
  }

  const ReplayOptions& options_;
  recording::TickReader reader_;
  bool noted_;
  RecordedTick tick_;
  bool more_ = false;
  DriveNote note_;
  std::unique_ptr<campaign::Trace> trace_;
  std::optional<recording::EcuRerun> ecu_;
  std::optional<world::Scenario> scenario_;
  std::optional<recording::WorldRerun> world_;
  recording::AsSeen seen_;
  recording::Agreement judged_;
  recording::Agreement before_;
  std::uint64_t ticks_ = 0;
};

int replay(ReplayOptions& options) {
  Pass pass(options, options.view);
  pass.run();
  const int code = pass.report(std::cout);
  if (!options.view) return code;
  options.common.choose_out();
  fs::create_directories(options.common.out);
  const fs::path page = options.common.out / "replay.html";
  pass.write_page(page, std::cout);
  std::cout << "replay: " << page.string()
            << (std::isfinite(options.from_s) ? format("#t=%.2f", std::max(0.0, options.from_s)) : "")
            << '\n';
  return code;
}

int cut(const ReplayOptions& options) {
  if (options.common.out_named->count() == 0) {
    throw std::runtime_error("--cut: name the folder it goes to: --out DIR");
  }
  const fs::path& folder = options.common.out;
  const recording::CutMade made = recording::write_cut(options.file, *options.cut_s, folder);
  const DriveNote note = recording::read_note(options.file);
  std::string command = "./s4tp run --scenario " + folder.string();
  if (!note.planner.empty() && note.planner != "s4tp") command += " --planner " + note.planner;
  if (!note.guarded) command += " --guard off";
  if (fs::exists(folder / "parameters.toml")) {
    command += " --parameters " + (folder / "parameters.toml").string();
  }
  std::cout << folder.string() << ": the drive's world as recorded until "
            << format("%.2f s (tick %d)", made.start_s, made.start_tick) << "; from then on who drives does\n"
            << "the same drive again, to the bit: " << command << '\n';
  return kDone;
}

}  // namespace

Command add_replay(CLI::App& tool) {
  CLI::App* replay_app = tool.add_subcommand(
      "replay",
      "a recording, or a log of the bus, into the ECU again: exit code 0 the same to the bit, 1 "
      "something differs, 2 cannot be judged");
  const auto options = std::make_shared<ReplayOptions>();
  options->common.out = fs::path("out") / "replay";
  replay_app->add_option("FILE", options->file, "recording (run --record) or log in candump's format")
      ->required();
  CLI::Option* const from = replay_app->add_option("--from", options->from_s,
                                                   "judge, and show, from then on [s]; 0: the ECU takes over "
                                                   "(a log: it begins). It is played from its start");
  CLI::Option* const view = replay_app->add_flag("--view", options->view, "also write DIR/replay.html");
  replay_app
      ->add_option("--cut", options->cut_s,
                   "make of this moment [s] a scenario in DIR that begins 10 s before it")
      ->excludes(from, view);
  options->common.out_named =
      replay_app->add_option("--out", options->common.out, "folder for that (--view: default out/replay)");
  replay_app->add_option("--planner", options->planner, "of a log that does not say it (default s4tp)")
      ->check(CLI::IsMember(campaign::planner_names()));
  replay_app->add_option("--guard", options->guard, "the same (default on)")
      ->check(CLI::IsMember({"on", "off"}));
  replay_app->add_option("--parameters", options->common.parameters_file,
                         "the same: TOML file of planner parameters");
  return {replay_app, [options] { return options->cut_s ? cut(*options) : replay(*options); }};
}

}  // namespace s4tp::commands
