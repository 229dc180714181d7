#include "sim_host/recording/cut.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "sim_host/recording/rerun.hpp"
#include "sim_host/recording/ticks.hpp"
#include "sim_host/world/scenario/cut.hpp"

namespace s4tp::recording {
namespace {

namespace fs = std::filesystem;

constexpr double kTick_s = 0.01;

std::string seconds(double time_s) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f s", time_s);
  return text;
}

/// What was driven; of a cut that was driven, what that is a cut of.
scenario::Cut origin_of(const DriveNote& note, const scenario::Scenario& scenario) {
  if (scenario.cut) return *scenario.cut;
  scenario::Cut cut;
  cut.flavour = note.flavour;
  cut.seed = note.seed;
  cut.traffic = note.traffic;
  cut.perception = note.perception;
  return cut;
}

}  // namespace

CutMade write_cut(const fs::path& file, double moment_s, const fs::path& folder) {
  if (!has_note(file)) {
    throw std::runtime_error(
        file.string() + ": no " + note_folder(file).string() +
        " beside it (./s4tp run --record writes one), so of what world it is nobody knows; --scenario NAME "
        "names its roads, for the same start with default drivers");
  }
  const DriveNote note = read_note(file);
  const scenario::Scenario scenario = scenario_of(file);
  TickReader reader(file);
  if (reader.series().begins_later()) {
    throw NoSuchWorld(file.string() +
                      ": the drive's beginning was not kept (--record-keep 0 keeps all), and "
                      "without it the drive cannot be made again");
  }
  const long moment_tick = note.take_over_tick + std::lround(moment_s / kTick_s);
  WorldRerun rerun(note, scenario);
  RecordedTick tick;
  long ticks = 0;
  for (; ticks < moment_tick && reader.next(tick); ++ticks) rerun.play(tick);
  if (moment_tick < 1 || ticks < moment_tick) {
    while (reader.next(tick)) ++ticks;
    throw std::runtime_error("--cut " + seconds(moment_s) + ": " + file.string() + " goes from " +
                             seconds((1 - note.take_over_tick) * kTick_s) + " to " +
                             seconds(static_cast<double>(ticks - note.take_over_tick) * kTick_s) +
                             " (the ECU takes over at 0)" +
                             (reader.series().damage().empty() ? "" : "; " + reader.series().damage()));
  }
  if (rerun.agreement().differing > 0) {
    throw NoSuchWorld("this program's world is not the one of the recording (" + note.versions + " then, " +
                      versions_here() + " now): " + rerun.agreement().first);
  }

  CutMade made;
  const long wanted = moment_tick - std::lround(kBefore_s / kTick_s);
  scenario::Cut cut = origin_of(note, scenario);
  const int before = cut.start_tick;  // until there the vehicle followed an older recording
  cut.start_tick = static_cast<int>(std::max<long>(before, wanted));
  for (int i = before; i < cut.start_tick; ++i) {
    cut.commands.push_back(rerun.commands()[static_cast<std::size_t>(i)]);
  }
  made.start_tick = cut.start_tick;
  made.start_s = (made.start_tick - note.take_over_tick) * kTick_s;

  fs::create_directories(folder);
  const fs::path driven = scenario.cut ? scenario.cut->of : scenario.files.front();
  fs::copy(scenario_folder(file), folder / "drive", fs::copy_options::recursive);
  cut.of = folder / "drive" /
           driven.lexically_normal().lexically_relative(scenario_folder(file).lexically_normal());
  if (parameters_crc(note.parameters) != parameters_crc(Parameters{})) {
    write_parameters(note.parameters, folder / "parameters.toml");
  }
  scenario::write_cut(cut,
                      "Cut out of a recorded drive at " + seconds(moment_s) + "; it begins at " +
                          seconds(made.start_s) + " (docs/recording.md).",
                      folder);
  return made;
}

}  // namespace s4tp::recording
