// The training's program (./s4tp train): apart from the host tool, as only it needs torch.

#include <torch/cuda.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <map>
#include <string>

#include "sim_host/train/evaluation.hpp"
#include "sim_host/train/image_export.hpp"
#include "sim_host/train/learning_curve.hpp"
#include "sim_host/train/predict.hpp"
#include "sim_host/train/trainer.hpp"
#include "sim_host/train/yields_row.hpp"

namespace s4tp::train {
namespace {

constexpr int kDone = 0;
constexpr int kWrongUse = 2;
constexpr int kInterrupted = 130;
constexpr double kMinutesBetweenCheckpoints = 2.0;

std::atomic<bool> stop{false};

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// The sizes there are, by name.
const std::map<std::string, satp::NetworkShape> kSizes{
    {"mcu", satp::kMcuShape}, {"teacher", satp::kTeacherShape}, {"full", satp::kFullShape}};

const satp::NetworkShape& shape_named(const std::string& size) {
  return kSizes.at(size);
}

void add_size(CLI::App& command, std::string& size) {
  command.add_option("--size", size, "mcu, teacher or full")->check(CLI::IsMember(kSizes));
}

struct RunOptions {
  std::filesystem::path data;
  std::filesystem::path out;
  std::string size = "mcu";
  int threads = 1;
  TrainingOptions training;
};

int run(const RunOptions& options) {
  use_threads(options.threads);
  const SampleSet set = samples_to_learn_from(options.data);
  std::filesystem::create_directories(options.out);
  const std::filesystem::path checkpoint = options.out / "checkpoint.pt";
  Trainer trainer(shape_named(options.size), options.training, set);
  if (std::filesystem::exists(checkpoint)) trainer.load(checkpoint);
  std::printf(
      "%s: %lld parameters, %zu samples, %lld steps of %lld from step %lld, seed %llu, %d threads, on %s\n",
      options.size.c_str(), static_cast<long long>(trainer.network().size()), set.size(),
      static_cast<long long>(trainer.steps()), static_cast<long long>(options.training.batch),
      static_cast<long long>(trainer.step()), static_cast<unsigned long long>(options.training.seed),
      options.threads, torch::cuda::is_available() ? "the GPU" : "the CPU");
  const double begin_s = now_s();
  const std::int64_t begin_step = trainer.step();
  double saved_s = begin_s;
  trainer.run(stop, [&](const CurvePoint& point) {
    const double step_s = (now_s() - begin_s) / static_cast<double>(trainer.step() - begin_step);
    std::printf(
        "step %6lld of %lld  position %.3f mode %.3f route %.3f yields %.3f  validation %.3f  "
        "likeliest %.3f m  nearest %.3f m  %.0f ms a step, %.0f min left\n",
        static_cast<long long>(point.step), static_cast<long long>(trainer.steps()), point.position,
        point.mode, point.route, point.yields, point.validation, point.top_1_m, point.best_of_modes_m,
        1000.0 * step_s, step_s * static_cast<double>(trainer.steps() - trainer.step()) / 60.0);
    std::fflush(stdout);
    write_curve(trainer.curve(), options.out / "curve.json");
    draw_curve(trainer.curve(), options.out / "curve.svg");
    if (now_s() - saved_s > 60.0 * kMinutesBetweenCheckpoints) {
      trainer.save(checkpoint);
      saved_s = now_s();
    }
  });
  trainer.save(checkpoint);
  if (!trainer.finished()) {
    std::printf("stopped at step %lld; the same command goes on from there\n",
                static_cast<long long>(trainer.step()));
    return kInterrupted;
  }
  std::printf("%s\n", checkpoint.c_str());
  return kDone;
}

void add_run(CLI::App& tool, RunOptions& options) {
  CLI::App& command = *tool.add_subcommand("run", "train a network, or go on with an interrupted training");
  command.add_option("--data", options.data, "folder of samples (./s4tp train data)")->required();
  command.add_option("--out", options.out, "folder of checkpoint and learning curve")->required();
  add_size(command, options.size);
  TrainingOptions& training = options.training;
  command.add_option("--seed", training.seed, "of everything random")
      ->capture_default_str()
      ->check([](const std::string& text) {  // CLI11 alone takes -1 for 2^64 - 1
        return text.find_first_not_of("0123456789") == std::string::npos ? ""
                                                                         : text + ": accepted are digits";
      });
  command.add_option("--steps", training.steps, "gradient steps; fewer where the data runs out")
      ->capture_default_str();
  command.add_option("--batch", training.batch, "scenes a step")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  command.add_option("--rate", training.rate, "of Adam, at most; it falls to 0 at the end")
      ->capture_default_str();
  command
      .add_option("--rough", training.rough, "share of scenes whose tracks are seen as roughly as real ones")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command.add_flag(
      "!--no-forks", training.forks,
      "learn only from what the ego did by itself, not from the branches of forks: what such a model "
      "promises beside one that saw both");
  command
      .add_option("--integers", training.integers,
                  "checkpoint of a trained mcu network: go on from it with the ECU's rounding in it, so that "
                  "its image loses less")
      ->check(CLI::ExistingFile);
  command
      .add_option(
          "--teacher", training.teacher,
          "checkpoint of a trained network of size teacher: learn from what it expects as well as from "
          "what happened")
      ->check(CLI::ExistingFile);
  command.add_option("--passes", training.passes, "times a scene is seen at most")->capture_default_str();
  command.add_option("--validate-every", training.validate_every, "steps between points of the curve")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command.add_option("--threads", options.threads, "results are the same for the same number only")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
}

struct FiguresOptions {
  EvaluationOptions evaluation;
  std::string size = "mcu";
  int threads = 1;
};

int figures(const FiguresOptions& options) {
  use_threads(options.threads);
  evaluate(shape_named(options.size), options.evaluation);
  return kDone;
}

struct YieldsOptions {
  std::filesystem::path data;
  std::filesystem::path from;
  std::filesystem::path image;
  std::filesystem::path source;
};

int fit_yields(const YieldsOptions& options) {
  use_threads(1);
  const SampleSet set = samples_to_learn_from(options.data);
  const std::vector<std::uint32_t> image = fit_yields_row(
      read_image(options.from), set, samples_of(set, Part::kTraining), samples_of(set, Part::kCalibration));
  write_image(image, options.image);
  if (!options.source.empty()) write_image_words(image, options.source);
  std::printf("%s: the row of yielding fitted, all else as in %s\n", options.image.c_str(),
              options.from.c_str());
  return kDone;
}

struct ExportOptions {
  std::filesystem::path data;
  std::filesystem::path checkpoint;
  std::filesystem::path image;
  std::filesystem::path source;
};

int export_network(const ExportOptions& options) {
  use_threads(1);
  const SampleSet set = samples_to_learn_from(options.data);
  const std::vector<std::size_t> calibration = samples_of(set, Part::kCalibration);
  const std::vector<std::size_t> samples = export_samples(set);
  const auto network = load_network(satp::kMcuShape, options.checkpoint);
  const double temperature = calibrated_temperature(*network, set, calibration);
  calibrate_yields(*network, set, calibration, temperature);
  const TrainedFor trained_for = read_trained_for(options.checkpoint);
  const IntegerRounding* const rounding = network->rounding();
  const Trained trained{network->arrays(), rounding ? std::optional(rounding->ranges()) : std::nullopt,
                        static_cast<float>(temperature), static_cast<std::uint32_t>(trained_for.steps),
                        static_cast<std::uint32_t>(trained_for.seed)};
  const std::vector<std::uint32_t> image = export_image(trained, set, samples);
  (void)image_forecasts(image, set, {}, false);  // what an ECU would refuse is not written
  write_image(image, options.image);
  if (!options.source.empty()) write_image_words(image, options.source);
  std::printf("%s: %zu bytes, temperature %.3f, scales from %zu samples\n", options.image.c_str(),
              4 * image.size(), temperature, samples.size());
  return kDone;
}

void add_export(CLI::App& tool, ExportOptions& options) {
  CLI::App& command =
      *tool.add_subcommand("export", "the weight image an ECU takes, out of a trained mcu network");
  command
      .add_option("--data", options.data,
                  "the samples it was trained on: their calibration part gives the scales")
      ->required();
  command.add_option("--checkpoint", options.checkpoint, "of ./s4tp train run")->required();
  command.add_option("--image", options.image, "file for the image")->required();
  command.add_option("--source", options.source,
                     "file for the same as a C++ constant: algo/satp/shipped_weights.inc");
}

void add_yields(CLI::App& tool, YieldsOptions& options) {
  CLI::App& command = *tool.add_subcommand(
      "yields", "fits how likely the futures of an image let us pass, and leaves all else of it as it is");
  command
      .add_option("--data", options.data,
                  "samples: their training part fits, their calibration part rescales")
      ->required();
  command.add_option("--from", options.from, "the image")->required()->check(CLI::ExistingFile);
  command.add_option("--image", options.image, "file for the new one")->required();
  command.add_option("--source", options.source, "file for the same as a C++ constant");
}

void add_figures(CLI::App& tool, FiguresOptions& options) {
  CLI::App& command =
      *tool.add_subcommand("figures", "what a trained network is worth, beside the kinematic predictor");
  EvaluationOptions& evaluation = options.evaluation;
  command
      .add_option("--data", evaluation.data,
                  "the samples it was trained on: their calibration part calibrates")
      ->required();
  command.add_option("--fresh", evaluation.fresh,
                     "samples to judge it on; else the validation part of --data");
  command.add_option("--checkpoint", evaluation.checkpoint,
                     "of ./s4tp train run; without one the image is judged alone");
  command.add_option("--image", evaluation.image, "of ./s4tp train export: judged as well");
  command.add_option("--json", evaluation.json, "file for all figures");
  command.add_option("--plot", evaluation.plot, "file for the reliability plot (SVG)");
  add_size(command, options.size);
  command.add_option("--threads", options.threads)->check(CLI::Range(1, 64))->capture_default_str();
}

int main_of(int argc, char** argv) {
  CLI::App tool{"s4tp train: trains the predictor's network"};
  tool.require_subcommand(1);
  RunOptions run_options;
  FiguresOptions figures_options;
  add_run(tool, run_options);
  add_figures(tool, figures_options);
  ExportOptions export_options;
  add_export(tool, export_options);
  YieldsOptions yields_options;
  add_yields(tool, yields_options);
  try {
    tool.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return tool.exit(error) == 0 ? kDone : kWrongUse;
  }
  std::signal(SIGINT, [](int) { stop = true; });
  std::signal(SIGTERM, [](int) { stop = true; });
  try {
    if (tool.got_subcommand("run")) return run(run_options);
    if (tool.got_subcommand("export")) return export_network(export_options);
    if (tool.got_subcommand("yields")) return fit_yields(yields_options);
    return figures(figures_options);
  } catch (const std::exception& error) {
    std::cerr << "s4tp train: " << error.what() << '\n';
  }
  return kWrongUse;
}

}  // namespace
}  // namespace s4tp::train

int main(int argc, char** argv) {
  return s4tp::train::main_of(argc, argv);
}
