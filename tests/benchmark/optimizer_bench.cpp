// The optimizer against Ipopt on recorded problems: cost of our 16 passes over that of the local optimum
// Ipopt finds from the same start, and from our solution.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "algo/trajectory/ilqr.hpp"
#include "tests/benchmark/recorded_problems.hpp"
#include "tests/benchmark/reference_solver.hpp"

namespace {

using namespace s4tp;             // NOLINT
using namespace s4tp::benchmark;  // NOLINT

constexpr int kPasses = 16;
constexpr double kWithin = 0.02;
constexpr double kShareAsked = 0.95;
constexpr double kNothing = 1e-3;  // score: a millimetre of progress; no difference of this size counts

/// One comparison of all problems.
struct Series {
  std::string name;
  int solved = 0;  ///< by the reference
  int within = 0;
  int better = 0;  ///< ours, by more than 2 %
  std::vector<double> ratios;

  void add(double ours, const ReferenceResult& reference) {
    if (!reference.converged) return;
    ++solved;
    const double over = ours - reference.cost;
    if (over <= kWithin * reference.cost + kNothing) ++within;
    if (over < -kWithin * reference.cost - kNothing) ++better;
    ratios.push_back((ours + kNothing) / (reference.cost + kNothing));
  }
  [[nodiscard]] double at(double share) {
    if (ratios.empty()) return 0.0;
    std::sort(ratios.begin(), ratios.end());
    return ratios[static_cast<std::size_t>(share * static_cast<double>(ratios.size() - 1))];
  }
};

int compare(const std::vector<RefinementProblem>& problems, const std::filesystem::path& out) {
  Series same_start{"from the same start", 0, 0, 0, {}};
  Series our_solution{"from our solution", 0, 0, 0, {}};
  double passes = 0.0;
  int capped = 0;
  double before = 0.0;
  double after = 0.0;
  const auto ilqr = std::make_unique<Ilqr>();
  for (const RefinementProblem& problem : problems) {
    Motion start;
    reference_motion(problem, start);
    Motion ours = start;
    const IlqrResult result = ilqr->solve(problem, kPasses, ours);
    passes += result.passes;
    capped += result.passes == kPasses ? 1 : 0;
    const double cost = cost_in_double(problem, ours);
    before += cost_in_double(problem, start);
    after += cost;
    same_start.add(cost, solve_by_ipopt(problem, start));
    our_solution.add(cost, solve_by_ipopt(problem, ours));
  }
  const double count = static_cast<double>(problems.size());
  std::cout << problems.size() << " problems; mean cost " << before / count << " -> " << after / count
            << " in " << passes / count << " passes, " << capped << " at the cap of " << kPasses << '\n';
  nlohmann::ordered_json json = {{"problems", problems.size()},
                                 {"mean_cost_before", before / count},
                                 {"mean_cost_after", after / count},
                                 {"mean_passes", passes / count},
                                 {"at_the_cap", capped}};
  bool good = true;
  for (Series* const series : {&same_start, &our_solution}) {
    const double share = static_cast<double>(series->within) / std::max(1, series->solved);
    good = good && share >= kShareAsked;
    std::cout << "Ipopt " << series->name << ": solved " << series->solved << "; ours within 2 % on "
              << 100.0 * share << " %, better on " << series->better << "; ours / Ipopt median "
              << series->at(0.5) << ", p95 " << series->at(0.95) << ", p99 " << series->at(0.99) << ", worst "
              << series->at(1.0) << '\n';
    json[series->name] = {{"solved", series->solved},      {"within_share", share},
                          {"better", series->better},      {"ratio_median", series->at(0.5)},
                          {"ratio_p95", series->at(0.95)}, {"ratio_p99", series->at(0.99)},
                          {"ratio_worst", series->at(1.0)}};
  }
  std::ofstream(out / "optimizer.json") << json.dump(2) << '\n';
  return good ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("the optimizer against Ipopt on problems recorded from drives");
  int count = 1000;
  int stride = 23;
  std::filesystem::path file;
  std::filesystem::path out = "out/bench";
  app.add_option("--problems", count, "how many are recorded (default 1000)")->check(CLI::PositiveNumber);
  app.add_option("--stride", stride, "one in so many planning cycles (default 23)")
      ->check(CLI::PositiveNumber);
  app.add_option("--read", file, "problems recorded before, instead of driving");
  app.add_option("--out", out, "where problems.bin and optimizer.json go (default out/bench)");
  CLI11_PARSE(app, argc, argv);
  try {
    std::filesystem::create_directories(out);
    const std::vector<RefinementProblem> problems =
        file.empty() ? record_problems(count, stride) : read_problems(file);
    if (file.empty()) write_problems(out / "problems.bin", problems);
    return compare(problems, out);
  } catch (const std::exception& error) {
    std::cerr << "optimizer_bench: " << error.what() << '\n';
    return 2;
  }
}
