#include "tests/benchmark/recorded_problems.hpp"

#include <fstream>
#include <stdexcept>
#include <type_traits>

#include "sim_host/baselines/planner_registry.hpp"
#include "sim_host/campaign/episode.hpp"

namespace s4tp::benchmark {
namespace {

constexpr char kMagic[8] = {'s', '4', 't', 'p', 'r', 'e', 'f', '2'};
static_assert(std::is_trivially_copyable_v<trajectory::RefinementProblem>);

constexpr const char* kScenarios[] = {"left_turn", "left_turn_t", "merge", "cruise", "overtake", "cut_in"};
constexpr const char* kFlavours[] = {"smarts", "social"};
constexpr int kCells = 12;
constexpr std::uint64_t kSeeds = 10000;  // those the planner was tuned on
constexpr double kDriveS = 20.0;         // standing longer teaches nothing

struct Recorder {
  RecordedProblems recorded;
  int stride = 1;
  int seen = 0;
};
Recorder recorder;  // planners are made by name, in the one thread that drives

class RecordingPlanner final : public planner::PlanningCycle {
 public:
  [[nodiscard]] Status plan(const planner::PlannerInput& input, Plan& plan,
                            planner::Explanation& explanation) {
    const Status status = planner::PlanningCycle::plan(input, plan, explanation);
    if (const trajectory::RefinementProblem* const problem = last_refinement()) keep(*problem);
    return status;
  }

 private:
  static void keep(const trajectory::RefinementProblem& problem) {
    trajectory::Motion start;
    trajectory::reference_motion(problem, start);
    if (trajectory::judge_motion(problem, start).cost() < kNothingToGain) {
      ++recorder.recorded.left_out;
    } else if (recorder.seen++ % recorder.stride == 0) {
      recorder.recorded.problems.push_back(problem);
    }
  }
};

const baselines::RegisterPlanner kRegistered{{"recording", "keeps what its optimizer was asked",
                                              baselines::ecu_with<RecordingPlanner>,
                                              baselines::ecu_with<RecordingPlanner>}};

}  // namespace

RecordedProblems record_problems(int count, int stride, const std::function<void(int)>& progress) {
  recorder = {{}, stride, 0};
  std::vector<trajectory::RefinementProblem>& problems = recorder.recorded.problems;
  const std::filesystem::path scenarios = std::filesystem::path(S4TP_SOURCE_DIR) / "sim_host" / "scenarios";
  int cell = 0;
  for (const char* const name : kScenarios) {
    for (const char* const flavour : kFlavours) {
      scenario::Scenario scenario = scenario::load_scenario(scenarios / name, flavour);
      scenario.mission.time_limit_s = kDriveS;
      const auto wanted = static_cast<std::size_t>(count * ++cell / kCells);
      for (std::uint64_t seed = 0; seed < kSeeds && problems.size() < wanted; ++seed) {
        campaign::EpisodeOptions options;
        options.seed = seed;
        options.planner = "recording";
        (void)run_episode(scenario, options);
        if (problems.size() > wanted) problems.resize(wanted);
        progress(static_cast<int>(problems.size()));
      }
    }
  }
  return recorder.recorded;
}

void write_problems(const std::filesystem::path& file, const RecordedProblems& recorded) {
  std::ofstream stream(file, std::ios::binary);
  const std::uint32_t header[] = {sizeof(trajectory::RefinementProblem), recorded.left_out};
  stream.write(kMagic, sizeof(kMagic));
  stream.write(reinterpret_cast<const char*>(header), sizeof(header));
  for (const trajectory::RefinementProblem& problem : recorded.problems) {
    stream.write(reinterpret_cast<const char*>(&problem), sizeof(problem));
  }
  if (!stream.flush()) throw std::runtime_error(file.string() + ": cannot be written");
}

RecordedProblems read_problems(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  char magic[sizeof(kMagic)] = {};
  std::uint32_t header[2] = {};
  stream.read(magic, sizeof(magic));
  stream.read(reinterpret_cast<char*>(header), sizeof(header));
  if (!stream || std::string(magic, sizeof(magic)) != std::string(kMagic, sizeof(kMagic))) {
    throw std::runtime_error(file.string() + ": holds no recorded problems");
  }
  if (header[0] != sizeof(trajectory::RefinementProblem)) {
    throw std::runtime_error(file.string() + ": recorded by a build whose problems have " +
                             std::to_string(header[0]) + " bytes, not " +
                             std::to_string(sizeof(trajectory::RefinementProblem)));
  }
  RecordedProblems recorded;
  recorded.left_out = header[1];
  trajectory::RefinementProblem problem;
  while (stream.read(reinterpret_cast<char*>(&problem), sizeof(problem)))
    recorded.problems.push_back(problem);
  return recorded;
}

}  // namespace s4tp::benchmark
