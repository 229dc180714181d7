// The optimizer against Ipopt on recorded problems: cost of our 16 passes over that of the local optimum
// Ipopt finds from the same start, and from our solution.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "algo/trajectory/ilqr.hpp"
#include "sim_host/campaign/progress.hpp"
#include "sim_host/processes/own_folder.hpp"
#include "tests/benchmark/recorded_problems.hpp"
#include "tests/benchmark/reference_solver.hpp"

namespace {

using namespace s4tp;             // NOLINT
using namespace s4tp::benchmark;  // NOLINT

constexpr int kPasses = 16;
constexpr double kWithin = 0.02;
constexpr double kShareAsked = 0.95;  // of those solved; and so many must be
constexpr double kRounding = 1e-6;    // of the score: our sums are float

/// One comparison of all problems.
struct Series {
  std::string name;
  int asked = 0;
  int solved = 0;  ///< by Ipopt
  int within = 0;  ///< ours costs at most 2 % more
  int better = 0;  ///< ours costs less by more than 2 %
  std::vector<double> ratios = {};

  void add(double ours, const ReferenceResult& reference) {
    ++asked;
    if (!reference.solved) return;
    ++solved;
    if (ours <= (1.0 + kWithin) * reference.cost + kRounding) ++within;
    if (ours < (1.0 - kWithin) * reference.cost - kRounding) ++better;
    ratios.push_back((ours + kRounding) / (reference.cost + kRounding));
  }
  [[nodiscard]] double within_share() const { return static_cast<double>(within) / std::max(1, solved); }
  [[nodiscard]] bool good() const { return within_share() >= kShareAsked && solved >= kShareAsked * asked; }
  [[nodiscard]] double at(double share) const {
    if (ratios.empty()) return 0.0;
    std::vector<double> sorted = ratios;
    std::sort(sorted.begin(), sorted.end());
    return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
  }
};

struct Comparison {
  std::size_t problems = 0;
  std::uint32_t left_out = 0;
  double before = 0.0;  ///< mean costs
  double after = 0.0;
  double passes = 0.0;  ///< mean
  int capped = 0;
  int kept = 0;  ///< start given back as it was
  Series series[2] = {{"from the same start"}, {"from our solution"}};
};

Comparison compare(const RecordedProblems& recorded) {
  Comparison all;
  all.problems = recorded.problems.size();
  all.left_out = recorded.left_out;
  const double share = 1.0 / static_cast<double>(std::max<std::size_t>(1, all.problems));
  const auto ilqr = std::make_unique<trajectory::Ilqr>();
  campaign::ConsoleProgress progress(all.problems);
  for (const trajectory::RefinementProblem& problem : recorded.problems) {
    trajectory::Motion start;
    trajectory::reference_motion(problem, start);
    trajectory::Motion ours = start;
    const trajectory::IlqrResult result = ilqr->solve(problem, kPasses, ours);
    const double cost = judge_in_double(problem, ours).cost;
    all.before += share * judge_in_double(problem, start).cost;
    all.after += share * cost;
    all.passes += share * result.passes;
    all.capped += result.passes == kPasses ? 1 : 0;
    all.kept += result.improved ? 0 : 1;
    all.series[0].add(cost, solve_by_ipopt(problem, start));
    all.series[1].add(cost, solve_by_ipopt(problem, ours));
    progress.done("problem compared");
  }
  progress.end();
  return all;
}

void print(const Comparison& all) {
  std::cout << all.problems << " problems from drives in six scenarios, both flavours; " << all.left_out
            << " between them left nothing to gain\n"
            << "ours: mean cost " << std::setprecision(3) << all.before << " -> " << all.after << " in "
            << all.passes << " passes, " << all.capped << " at the cap of " << kPasses << ", " << all.kept
            << " starts given back\n\n"
            << "Ipopt                solved  ours within 2 %  ours better  Ipopt better  "
               "ours / Ipopt: median    p95    p99  worst\n"
            << std::fixed;
  for (const Series& series : all.series) {
    std::cout << std::left << std::setw(20) << series.name << std::right << std::setw(7) << series.solved
              << std::setprecision(1) << std::setw(15) << 100.0 * series.within_share() << " %"
              << std::setw(13) << series.better << std::setw(14) << series.solved - series.within
              << std::setprecision(3) << std::setw(22) << series.at(0.5) << std::setw(7) << series.at(0.95)
              << std::setw(7) << series.at(0.99) << std::setw(7) << series.at(1.0) << '\n';
  }
  std::cout << "better: by more than 2 %. Asked: within 2 % on 95 %\n";
}

RecordedProblems record(int count, int stride) {
  campaign::ConsoleProgress progress(static_cast<std::size_t>(count));
  int told = 0;
  const auto tell = [&](int there) {  // a drive brings none, or several
    for (; told < there; ++told) progress.done("problem recorded");
  };
  RecordedProblems recorded = record_problems(count, stride, tell);
  progress.end();
  return recorded;
}

nlohmann::ordered_json json_of(const Comparison& all) {
  nlohmann::ordered_json json = {{"problems", all.problems},       {"left_out", all.left_out},
                                 {"mean_cost_before", all.before}, {"mean_cost_after", all.after},
                                 {"mean_passes", all.passes},      {"at_the_cap", all.capped},
                                 {"starts_given_back", all.kept}};
  for (const Series& series : all.series) {
    json[series.name] = {{"solved", series.solved},        {"within_share", series.within_share()},
                         {"ours_better", series.better},   {"ipopt_better", series.solved - series.within},
                         {"ratio_median", series.at(0.5)}, {"ratio_p95", series.at(0.95)},
                         {"ratio_p99", series.at(0.99)},   {"ratio_worst", series.at(1.0)}};
  }
  return json;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "The optimizer against Ipopt on problems recorded from drives (docs/optimizer.md).\n"
      "exit code: 0 within 2 % on 95 %, 1 not, 2 cannot be judged",
      "./s4tp bench");
  int count = 1000;
  int stride = 23;
  std::filesystem::path file;
  std::filesystem::path out = "out/bench";
  std::filesystem::path json;
  app.add_option("--problems", count, "how many are recorded (default 1000)")->check(CLI::PositiveNumber);
  app.add_option("--stride", stride, "one in so many that have something to gain (default 23)")
      ->check(CLI::PositiveNumber);
  app.add_option("--read", file, "problems recorded before, instead of driving");
  app.add_option("--json", json, "the numbers (default: results.json in --out)");
  const CLI::Option* const out_named =
      app.add_option("--out", out, "where problems.bin is kept (default out/bench)");
  CLI11_PARSE(app, argc, argv);
  try {
    const processes::OwnFolder own = processes::choose_folder(out, out_named->count() > 0);
    std::filesystem::create_directories(out);
    const RecordedProblems recorded = file.empty() ? record(count, stride) : read_problems(file);
    if (file.empty()) write_problems(out / "problems.bin", recorded);
    const Comparison all = compare(recorded);
    print(all);
    if (json.empty()) json = out / "results.json";
    if (!(std::ofstream(json) << json_of(all).dump(2) << '\n')) {
      throw std::runtime_error(json.string() + ": cannot be written");
    }
    return all.series[0].good() && all.series[1].good() ? 0 : 1;
  } catch (const std::exception& error) {
    std::cerr << "optimizer_bench: " << error.what() << '\n';
    return 2;
  }
}
