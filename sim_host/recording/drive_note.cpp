#include "sim_host/recording/drive_note.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>
#include <vector>

#include "algo/core/parameter_info.hpp"
#include "algo/core/versions.hpp"
#include "sim_host/campaign/digest.hpp"
#include "sim_host/campaign/parameters_file.hpp"
#include "sim_host/campaign/record_limits.hpp"
#include "sim_host/world/nodes/perception.hpp"
#include "sim_host/world/scenario/listed.hpp"
#include "sim_host/world/scenario/whole_file.hpp"
#include "sim_host/world/traffic/traffic_engine.hpp"

namespace s4tp::recording {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr std::uint64_t kVersion = 1;
constexpr std::array<const char*, 3> kMeetings{"in process", "lock-step", "real time"};
constexpr std::uint64_t kTakeOverMax = 100'000;
constexpr std::uintmax_t kNoteBytes = 1 << 20;

fs::path json_file(const fs::path& file) {
  return note_folder(file) / "drive.json";
}

fs::path parameters_file(const fs::path& file) {
  return note_folder(file) / "parameters.toml";
}

std::string digest_of(const std::vector<fs::path>& files) {
  campaign::Digest digest;
  for (const fs::path& one : files) digest.add_file(one);
  return digest.hex();
}

/// The folder that holds all of them, and the scenario's own folder with its name.
fs::path common_folder(const std::vector<fs::path>& files) {
  fs::path common = files.front().parent_path().parent_path();
  for (const fs::path& file : files) {
    while (file.lexically_relative(common).begin()->string() == "..") common = common.parent_path();
  }
  return common;
}

ordered_json read_json(const fs::path& file) {
  const std::string text = scenario::whole_file(file, kNoteBytes);
  try {
    return campaign::parse_json(text);
  } catch (const std::exception& error) {
    throw std::runtime_error(file.string() + ": " + error.what());
  }
}

void write_json(const DriveNote& note, ordered_json json, const fs::path& file) {
  if (note.ticks > 0) json["ticks"] = note.ticks;
  std::ofstream stream(json_file(file));
  stream << json.dump(1) << '\n';
  stream.close();
  if (!stream) throw std::runtime_error(json_file(file).string() + ": cannot be written");
}

std::string name_in(const ordered_json& json, const std::string& key, const std::vector<std::string>& names) {
  const std::string name = json.at(key).get<std::string>();
  if (std::find(names.begin(), names.end(), name) != names.end()) return name;
  throw std::runtime_error(key + ": accepted is one of " + scenario::listed(names));
}

}  // namespace

fs::path note_folder(const fs::path& file) {
  return file.string() + ".drive";
}

std::string versions_here() {
  return "API " + std::to_string(kApiVersion) + ", wire " + std::to_string(kWireVersion) + ", parameters " +
         std::to_string(kParametersVersion) + ", weights " + std::to_string(kWeightsVersion);
}

void write_parameters(const Parameters& parameters, const fs::path& file) {
  std::ofstream stream(file);
  stream.precision(std::numeric_limits<float>::max_digits10);
  stream << std::showpoint;  // a float to TOML
  std::string group;
  for (int i = 0; i < kParameterCount; ++i) {
    if (get_parameter(parameters, i) == get_parameter(Parameters{}, i)) continue;
    const std::string name = parameter_info(i).name;
    const std::size_t dot = name.find('.');
    if (name.substr(0, dot) != std::exchange(group, name.substr(0, dot))) stream << '[' << group << "]\n";
    stream << name.substr(dot + 1) << " = " << get_parameter(parameters, i) << '\n';
  }
  stream.close();
  if (!stream) throw std::runtime_error(file.string() + ": cannot be written");
}

void write_note(const DriveNote& note, const scenario::Scenario& scenario, const fs::path& file) {
  const fs::path folder = note_folder(file);
  fs::create_directories(folder);
  std::vector<fs::path> files;
  for (const fs::path& one : scenario.files) files.push_back(fs::weakly_canonical(one));
  const fs::path common = common_folder(files);
  for (const fs::path& one : files) {
    const fs::path copy = scenario_folder(file) / one.lexically_relative(common);
    fs::create_directories(copy.parent_path());
    fs::copy_file(one, copy, fs::copy_options::skip_existing);
  }
  if (parameters_crc(note.parameters) != parameters_crc(Parameters{})) {
    write_parameters(note.parameters, parameters_file(file));
  }
  write_json(note,
             {{"kind", "s4tp recording"},
              {"version", kVersion},
              {"name", note.scenario},
              {"scenario", files.front().lexically_relative(common).generic_string()},
              {"flavour", note.flavour},
              {"digest", digest_of(files)},
              {"seed", note.seed},
              {"traffic", note.traffic},
              {"perception", note.perception},
              {"planner", note.planner},
              {"guarded", note.guarded},
              {"parameters_crc", parameters_crc(note.parameters)},
              {"bus", kMeetings.at(static_cast<std::size_t>(note.meeting))},
              {"take_over_tick", note.take_over_tick},
              {"versions", versions_here()},
              {"build", campaign::build_digest()}},
             file);
}

void end_note(const DriveNote& note, const fs::path& file) {
  write_json(note, read_json(json_file(file)), file);
}

bool has_note(const fs::path& file) {
  return fs::exists(json_file(file));
}

DriveNote read_note(const fs::path& file) {
  const ordered_json json = read_json(json_file(file));
  DriveNote note;
  try {
    if (json.at("kind") != "s4tp recording") throw std::runtime_error("kind: accepted is \"s4tp recording\"");
    (void)campaign::whole_number(json.at("version"), "version", kVersion, kVersion);
    note.scenario = json.at("name").get<std::string>();
    note.flavour = json.at("flavour").get<std::string>();
    note.seed = campaign::whole_number(json.at("seed"), "seed", 0, campaign::kSeedMax);
    note.traffic = name_in(json, "traffic", scenario::engine_names());
    note.perception = name_in(json, "perception", scenario::perception_names());
    note.planner = json.at("planner").get<std::string>();
    note.guarded = json.at("guarded").get<bool>();
    const std::string bus = name_in(json, "bus", {kMeetings.begin(), kMeetings.end()});
    note.meeting =
        static_cast<Meeting>(std::find(kMeetings.begin(), kMeetings.end(), bus) - kMeetings.begin());
    note.take_over_tick = static_cast<int>(
        campaign::whole_number(json.at("take_over_tick"), "take_over_tick", 0, kTakeOverMax));
    note.versions = json.at("versions").get<std::string>();
    if (json.contains("ticks"))
      note.ticks = campaign::whole_number(json.at("ticks"), "ticks", 1, campaign::kSeedMax);
    if (fs::exists(parameters_file(file))) note.parameters = campaign::load_parameters(parameters_file(file));
    if (json.at("parameters_crc") != parameters_crc(note.parameters)) {
      throw std::runtime_error(
          "parameters_crc: the parameters of this program, with parameters.toml where "
          "there is one, are not those driven with");
    }
  } catch (const std::exception& error) {
    throw std::runtime_error(json_file(file).string() + ": " + error.what());
  }
  return note;
}

scenario::Scenario scenario_of(const fs::path& file) {
  const ordered_json json = read_json(json_file(file));
  fs::path place;
  try {
    place = json.at("scenario").get<std::string>();
    (void)json.at("digest").get<std::string>();
  } catch (const std::exception& error) {
    throw std::runtime_error(json_file(file).string() + ": " + error.what());
  }
  scenario::Scenario scenario =
      scenario::load_scenario(scenario_folder(file) / place, read_note(file).flavour);
  if (digest_of(scenario.files) != json.at("digest")) {
    throw std::runtime_error(scenario_folder(file).string() +
                             ": the scenario's files are not as they were in the drive");
  }
  return scenario;
}

fs::path scenario_folder(const fs::path& file) {
  return note_folder(file) / "scenario";
}

}  // namespace s4tp::recording
