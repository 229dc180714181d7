#include <unistd.h>

#include <chrono>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "sim_host/campaign/results.hpp"
#include "sim_host/commands/command.hpp"
#include "sim_host/processes/stop_signals.hpp"
#include "sim_host/roads/generator.hpp"
#include "sim_host/train/clip_samples.hpp"
#include "sim_host/train/data_drive.hpp"
#include "sim_host/train/sample_file.hpp"
#include "sim_host/world/traffic/random.hpp"

namespace s4tp::commands {
namespace {

constexpr std::size_t kSamplesPerFile = 5'000;
constexpr std::uint64_t kMostBytes = 4'000'000'000;  // a disk's share, whatever was asked for
constexpr double kPlainLineEvery_s = 10.0;           // where nobody watches, but a log is kept
constexpr std::uint64_t kShippedFrom = 1'000'000;    // below it samples are told apart by the road's number
constexpr std::uint64_t kFlavourStep = 50'000;       // between a scenario's seeds in its two flavours

const std::vector<std::string> kShipped{"left_turn", "left_turn_t", "merge", "cruise", "overtake", "cut_in"};
const std::vector<std::string> kFlavours{"smarts", "social"};

struct DataOptions {
  CommonOptions common;
  std::uint64_t first_road = 0;
  int roads = 100;
  int rounds = 100;
  double minutes = 0.0;
  double noisy_share = 0.3;
  bool reporting = false;
  std::filesystem::path clips;
  std::filesystem::path json;
};

/// Who drives: mostly the firmware, guarded or not; others for the sake of egos that drive differently.
struct Share {
  const char* planner;
  bool guarded;
  double share;
};
constexpr Share kWhoDrives[] = {{"s4tp", true, 0.5},
                                {"s4tp", false, 0.25},
                                {"idm_lane", true, 0.1},
                                {"predictive_decision_kinematic", true, 0.05},
                                {"constant_speed", false, 0.05},
                                {"blind", false, 0.05}};

/// A data set being made: files, progress, and when to stop.
class DataSet {
 public:
  explicit DataSet(const DataOptions& options) : options_(options), stop_(processes::stop_on_signals()) {
    std::filesystem::create_directories(options.common.out);
  }

  [[nodiscard]] bool done() const {
    return stop_ || bytes_ >= kMostBytes || (options_.minutes > 0.0 && seconds() > 60.0 * options_.minutes);
  }
  [[nodiscard]] bool stopped() const { return stop_; }

  void drive(const scenario::Scenario& scenario, std::uint64_t road, train::SampleScenario kind,
             std::uint64_t seed) {
    traffic::Random random(traffic::next_seed(road * 65'536 + seed));
    train::DriveOptions drive;
    drive.seed = seed;
    drive.road = road;
    drive.scenario = kind;
    drive.reporting = options_.reporting;
    drive.noisy = random.uniform() < options_.noisy_share;
    double left = random.uniform();
    for (const Share& who : kWhoDrives) {
      drive.planner = who.planner;
      drive.guarded = who.guarded;
      left -= who.share;
      if (left < 0.0) break;
    }
    ++drives_;
    counts_ += train::make_samples(scenario, drive, [&](const train::Sample& sample) { add(sample); });
    tell(false);
  }

  /// Windows of recorded drivers (docs/recorded_clips.md).
  void join(const std::filesystem::path& folder) {
    clips::Windows windows;
    for (const std::filesystem::path& file : clips::clip_files(folder)) {
      if (done()) return;
      train::make_clip_samples(clips::load_clip(file), windows, Parameters{},
                               [&](const train::Sample& sample) {
                                 add(sample);
                                 ++clip_samples_;
                               });
    }
  }

  void close() {
    if (writer_) writer_->close();
    tell(true);
  }

  [[nodiscard]] nlohmann::json figures() const {
    return {{"drives", drives_},
            {"forks", counts_.forks},
            {"branches", counts_.branches},
            {"collided", counts_.collided},
            {"samples", counts_.samples},
            {"forked_samples", counts_.forked},
            {"clip_samples", clip_samples_},
            {"simulated_s", counts_.driven_s},
            {"wall_s", seconds()},
            {"bytes", bytes_},
            {"samples_per_s", counts_.samples / seconds()}};
  }
  [[nodiscard]] std::string words() const {
    std::ostringstream text;
    text << drives_ << " drives, " << counts_.forks << " forks, " << counts_.samples << " samples ("
         << counts_.forked << " of forks), " << counts_.collided << " of " << counts_.branches
         << " branches collided; " << clip_samples_ << " samples of clips; "
         << static_cast<int>(counts_.samples / seconds()) << " samples/s";
    return text.str();
  }

 private:
  /// In place on a terminal; into a log at most a line every ten seconds.
  void tell(bool last) {
    const bool terminal = isatty(STDERR_FILENO) != 0;
    if (!terminal && !last && drives_ != 1 && seconds() < told_s_ + kPlainLineEvery_s) return;
    std::cerr << (terminal ? "\r" : "") << words() << (terminal && !last ? "  " : "\n") << std::flush;
    told_s_ = seconds();
  }

  double told_s_ = 0.0;

  void add(const train::Sample& sample) {
    if (writer_ && writer_->size() >= kSamplesPerFile) {
      writer_->close();
      writer_.reset();
    }
    if (!writer_) {
      char name[32];
      std::snprintf(name, sizeof name, "data_%03d.samples", files_++);
      writer_.emplace(options_.common.out / name);
    }
    writer_->add(sample);
    bytes_ += sizeof sample;
  }
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  }

  const DataOptions& options_;
  const std::atomic<bool>& stop_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::optional<train::SampleWriter> writer_;
  int files_ = 0;
  std::uint64_t bytes_ = 0;
  int drives_ = 0;
  int clip_samples_ = 0;
  train::DriveCounts counts_;
};

int run(DataOptions& options) {
  const std::uint64_t last = options.common.seed + static_cast<std::uint64_t>(options.rounds);
  const std::uint64_t last_road = options.first_road + static_cast<std::uint64_t>(options.roads);
  using train::kBlocksBegin;
  if (!options.reporting && (last > kBlocksBegin || last_road > kBlocksBegin)) {
    throw std::invalid_argument(
        "seeds and roads from 10000 on are for reporting: ask for them with --reporting, and nothing learns "
        "from them");
  }
  if (options.reporting && (options.common.seed < kBlocksBegin || last > kFlavourStep ||
                            options.first_road < kBlocksBegin || last_road > kShippedFrom)) {
    throw std::invalid_argument(
        "--reporting takes --seed from 10000 up to 50000 and --first-road from 10000 up to 1000000");
  }
  DataSet set(options);
  std::vector<scenario::Scenario> shipped;
  for (const std::string& flavour : kFlavours) {
    options.common.flavour = flavour;
    for (const std::string& name : kShipped) shipped.push_back(options.common.find_scenario(name));
  }
  // A round: a seed of each shipped scenario, and as many roads as make all of them come once in all rounds.
  int next_road = 0;
  for (int round = 0; round < options.rounds && !set.done(); ++round) {
    const std::uint64_t seed = options.common.seed + static_cast<std::uint64_t>(round);
    for (std::size_t i = 0; i < shipped.size() && !set.done(); ++i) {
      const std::size_t kind = i % kShipped.size();
      const std::uint64_t flavour = i / kShipped.size();
      set.drive(shipped[i], kShippedFrom + (2 * kind + flavour) * kFlavourStep + seed,
                static_cast<train::SampleScenario>(kind), seed);
    }
    const int roads_until =
        static_cast<int>(static_cast<std::int64_t>(options.roads) * (round + 1) / options.rounds);
    for (; next_road < roads_until && !set.done(); ++next_road) {
      const std::uint64_t number = options.first_road + static_cast<std::uint64_t>(next_road);
      const roads::WrittenRoad road = roads::write_road(number, options.common.scenario_root / "social.toml",
                                                        options.common.out / "roads");
      for (const std::string& flavour : kFlavours) {
        if (set.done()) break;
        set.drive(scenario::load_scenario(road.folder, flavour), number, train::SampleScenario::kGenerated,
                  2 * number + (flavour == "social" ? 1 : 0));
      }
    }
  }
  if (!options.clips.empty()) set.join(options.clips);
  set.close();
  std::cout << set.words() << '\n';
  if (!options.json.empty()) campaign::write_json(options.json, set.figures());
  return set.stopped() ? kInterrupted : kDone;
}

}  // namespace

Command add_train(CLI::App& tool) {
  CLI::App* train = tool.add_subcommand("train", "data for the learned predictor");
  train->require_subcommand(1);
  CLI::App* data = train->add_subcommand("data", "drives, forks and writes training samples");
  const auto options = std::make_shared<DataOptions>();
  data->add_option("--out", options->common.out, "folder of the data set")->required();
  data->add_option("--seed,--first-seed", options->common.seed,
                   "first seed of the shipped scenarios (default 0)")
      ->check(kSeed);
  data->add_option(
          "--rounds", options->rounds,
          "seeds of each shipped scenario in both flavours; the roads spread over them (default 100)")
      ->check(CLI::PositiveNumber);
  data->add_option("--first-road", options->first_road, "first number of the generated roads (default 0)");
  data->add_option("--roads", options->roads, "how many of them (default 100)")
      ->check(CLI::NonNegativeNumber);
  data->add_option("--minutes", options->minutes, "stop after so long; the set is then not reproducible");
  data->add_option("--noisy-share", options->noisy_share, "drives with perception as it is (default 0.3)")
      ->check(CLI::Range(0.0, 1.0));
  data->add_flag(
      "--reporting", options->reporting,
      "of seeds and roads from 10000 on: samples that figures are judged on, and nothing learns from");
  data->add_option("--clips", options->clips,
                   "folder of recorded clips: the windows of four of five vehicles join the samples");
  data->add_option("--json", options->json, "write what was made here");
  data->add_option("--scenarios-folder", options->common.scenario_root, "where shipped scenarios lie");
  return {train, [options] { return run(*options); }};
}

}  // namespace s4tp::commands
