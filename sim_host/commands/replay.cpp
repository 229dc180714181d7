#include "sim_host/view/replay.hpp"

#include <cmath>
#include <iostream>
#include <limits>
#include <optional>
#include <stdexcept>

#include "sim_host/baselines/planner_registry.hpp"
#include "sim_host/commands/command.hpp"
#include "sim_host/recording/cut.hpp"
#include "sim_host/recording/playback.hpp"
#include "sim_host/recording/same_start.hpp"
#include "sim_host/recording/ticks.hpp"
#include "sim_host/view/html.hpp"

namespace s4tp::commands {
namespace {

namespace fs = std::filesystem;
using recording::DriveNote;
using view::format;

struct ReplayOptions {
  CommonOptions common;
  fs::path file;
  std::string planner = "s4tp";
  std::string guard = "on";
  double from_s = -std::numeric_limits<double>::infinity();
  bool view = false;
  std::optional<double> cut_s;
  std::string roads;
};

/// A moment, not "nan" and no number beyond any drive.
const CLI::Validator kMoment{
    [](const std::string& text) {
      double value = 0.0;
      const bool good = CLI::detail::lexical_cast(text, value) && std::abs(value) <= 1e8;
      return good ? std::string() : text + ": accepted is a time in seconds, such as 12.5";
    },
    "TIME_S"};

/// A name as a shell takes it back.
std::string word(const fs::path& path) {
  const std::string text = path.string();
  const bool plain = text.find_first_of(" \t\"'\\$&;|<>()*?[]#~`!") == std::string::npos;
  if (plain) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + '\'';
}

recording::PlaybackOptions playback_options(const ReplayOptions& options) {
  recording::PlaybackOptions playback;
  playback.file = options.file;
  playback.without_note.planner = options.planner;
  playback.without_note.guarded = options.guard == "on";
  playback.without_note.parameters = options.common.parameters();
  playback.from_s = options.from_s;
  playback.page = options.view;
  return playback;
}

int replay(ReplayOptions& options) {
  recording::Playback playback(playback_options(options));
  playback.run();
  const int code = playback.report(std::cout);
  if (!options.view) return code;
  const OwnFolder folder = options.common.choose_out();
  fs::create_directories(options.common.out);
  const fs::path page = options.common.out / "replay.html";
  playback.write_page(page, std::cout);
  std::cout << "replay: " << page.string()
            << (std::isfinite(options.from_s) ? format("#t=%.2f", std::max(0.0, options.from_s)) : "")
            << '\n';
  return code;
}

/// Of a drive's first tick that was kept [s], where older files of its recording are gone; else 0.
double kept_from_s(const fs::path& file) {
  recording::TickReader reader(file);
  recording::RecordedTick first;
  return reader.series().begins_later() && reader.next(first) ? 1e-6 * static_cast<double>(reader.begin_us())
                                                              : 0.0;
}

int cut_same_start(const ReplayOptions& options, const scenario::Scenario& roads) {
  const DriveNote note = recording::Playback(playback_options(options)).note();
  const double start_s = *options.cut_s + note.take_over_tick * traffic::kTick_s - recording::kBefore_s -
                         kept_from_s(options.file);
  const recording::StartMade made =
      recording::write_same_start(options.file, note, start_s, roads, options.common.out);
  std::cout << options.common.out.string() << ": the start 10 s before; of " << made.told << " vehicles told "
            << made.there << " are there with default drivers, " << made.told - made.left_out - made.there
            << " find no room at once, " << made.left_out << " were inside junctions or beside the road\n"
            << "drive it: ./s4tp run --scenario " << word(options.common.out) << '\n';
  return kDone;
}

/// Exactly where the drive was of our world, else the same start on its roads; with --scenario on those.
int cut(const ReplayOptions& options) {
  if (options.common.out_named->count() == 0) {
    throw std::runtime_error("--cut: name the folder it goes to: --out DIR");
  }
  const fs::path& folder = options.common.out;
  if (fs::exists(folder) && !(fs::is_directory(folder) && fs::is_empty(folder))) {
    throw std::runtime_error(folder.string() + ": is there already; name another --out");
  }
  if (!options.roads.empty()) return cut_same_start(options, options.common.find_scenario(options.roads));
  recording::CutMade made;
  try {
    made = recording::write_cut(options.file, *options.cut_s, folder);
  } catch (const recording::NoSuchWorld& reason) {
    std::cout << reason.what()
              << "\nso it is the same start on the recording's own roads, with default drivers\n";
    return cut_same_start(options, recording::scenario_of(options.file));
  }
  const DriveNote note = recording::read_note(options.file);
  std::string command = "./s4tp run --scenario " + word(folder);
  if (!note.planner.empty() && note.planner != "s4tp") command += " --planner " + note.planner;
  if (!note.guarded) command += " --guard off";
  if (fs::exists(folder / "parameters.toml")) {
    command += " --parameters " + word(folder / "parameters.toml");
  }
  std::cout << folder.string() << ": the drive's world"
            << (made.start_tick > 0
                    ? format(" as recorded until %.2f s (tick %d); from then on who drives does",
                             made.start_s, made.start_tick)
                    : std::string(" from its beginning"))
            << '\n'
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
  CLI::Option* const from = replay_app
                                ->add_option("--from", options->from_s,
                                             "judge, and show, from then on [s]; 0: the ECU takes over "
                                             "(a log: it begins). It is played from its start")
                                ->check(kMoment);
  CLI::Option* const view = replay_app->add_flag("--view", options->view, "also write DIR/replay.html");
  CLI::Option* const cut_option =
      replay_app
          ->add_option("--cut", options->cut_s,
                       "make of this moment [s] a scenario in DIR that begins 10 s before it")
          ->check(kMoment)
          ->excludes(from, view);
  replay_app
      ->add_option("--scenario", options->roads,
                   "of a log that does not name its roads: --cut makes the same start on these, with default "
                   "drivers")
      ->needs(cut_option);
  options->common.out_named =
      replay_app->add_option("--out", options->common.out, "folder for that (--view: default out/replay)");
  replay_app->add_option("--planner", options->planner, "of a log that does not say it (default s4tp)")
      ->check(CLI::IsMember(baselines::planner_names()));
  replay_app->add_option("--guard", options->guard, "the same (default on)")
      ->check(CLI::IsMember({"on", "off"}));
  replay_app->add_option("--parameters", options->common.parameters_file,
                         "the same: TOML file of planner parameters");
  return {replay_app, [options] { return options->cut_s ? cut(*options) : replay(*options); }};
}

}  // namespace s4tp::commands
