#include "tests/benchmark/recorded_problems.hpp"

#include <fstream>
#include <stdexcept>
#include <type_traits>

#include "sim_host/campaign/episode.hpp"
#include "sim_host/campaign/planner_registry.hpp"

namespace s4tp::benchmark {
namespace {

constexpr char kMagic[8] = {'s', '4', 't', 'p', 'r', 'e', 'f', '1'};
static_assert(std::is_trivially_copyable_v<RefinementProblem>);

struct Recorder {
  std::vector<RefinementProblem> problems;
  int stride = 1;
  int seen = 0;
};
Recorder recorder;  // planners are made by name, in the one thread that drives

class RecordingPlanner : public Planner {
 public:
  [[nodiscard]] Status plan(const PlannerInput& input, Plan& plan, Explanation& explanation) {
    const Status status = Planner::plan(input, plan, explanation);
    const RefinementProblem* const problem = last_refinement();
    if (problem != nullptr && recorder.seen++ % recorder.stride == 0) recorder.problems.push_back(*problem);
    return status;
  }
};

const campaign::RegisterPlanner kRegistered{{"recording", "keeps what its optimizer was asked",
                                             campaign::ecu_with<RecordingPlanner>,
                                             campaign::ecu_with<RecordingPlanner>}};

}  // namespace

std::vector<RefinementProblem> record_problems(int count, int stride) {
  recorder = {{}, stride, 0};
  const std::filesystem::path scenarios = std::filesystem::path(S4TP_SOURCE_DIR) / "sim_host" / "scenarios";
  for (std::uint64_t seed = 0; seed < 10000; ++seed) {
    for (const char* const name : {"left_turn", "left_turn_t", "merge", "cruise", "overtake", "cut_in"}) {
      for (const char* const flavour : {"smarts", "social"}) {
        world::Scenario scenario = world::load_scenario(scenarios / name, flavour);
        scenario.mission.time_limit_s = 20.0;  // standing longer teaches nothing
        campaign::EpisodeOptions options;
        options.seed = seed;
        options.planner = "recording";
        (void)run_episode(scenario, options);
        if (static_cast<int>(recorder.problems.size()) >= count) {
          recorder.problems.resize(static_cast<std::size_t>(count));
          return recorder.problems;
        }
      }
    }
  }
  return recorder.problems;
}

void write_problems(const std::filesystem::path& file, const std::vector<RefinementProblem>& problems) {
  std::ofstream stream(file, std::ios::binary);
  const std::uint32_t size = sizeof(RefinementProblem);
  stream.write(kMagic, sizeof(kMagic));
  stream.write(reinterpret_cast<const char*>(&size), sizeof(size));
  for (const RefinementProblem& problem : problems) {
    stream.write(reinterpret_cast<const char*>(&problem), sizeof(problem));
  }
  if (!stream.flush()) throw std::runtime_error(file.string() + ": cannot be written");
}

std::vector<RefinementProblem> read_problems(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  char magic[sizeof(kMagic)] = {};
  std::uint32_t size = 0;
  stream.read(magic, sizeof(magic));
  stream.read(reinterpret_cast<char*>(&size), sizeof(size));
  if (!stream || std::string(magic, sizeof(magic)) != std::string(kMagic, sizeof(kMagic))) {
    throw std::runtime_error(file.string() + ": holds no recorded problems");
  }
  if (size != sizeof(RefinementProblem)) {
    throw std::runtime_error(file.string() + ": recorded by a build whose problems have " +
                             std::to_string(size) + " bytes, not " +
                             std::to_string(sizeof(RefinementProblem)));
  }
  std::vector<RefinementProblem> problems;
  RefinementProblem problem;
  while (stream.read(reinterpret_cast<char*>(&problem), sizeof(problem))) problems.push_back(problem);
  return problems;
}

}  // namespace s4tp::benchmark
