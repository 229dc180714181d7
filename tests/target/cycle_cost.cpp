/// What a planning cycle costs in scenes made to be dear (cost_scene.hpp), in SysTick counts of each stage, and how far
/// that is beyond what it was charged. Reads a script, a command a line:
///   unit N           what a unit of work is charged for, in counts; before the first scene
///   scene GENOME     measures it: prints the most of its cycles, row by row; a search goes on from it
///   charges          prints what each cycle was charged, stage by stage, beside what it took
///   uncapped         without the allowances of work: what they are there for
///   search SEED N    measures N scenes more, and prints the worst of each row
/// Exit code: 0, or 2 when the script cannot be read.

#include "algo/core/self_test.hpp"
#include "firmware/targets/platform.hpp"
#include "firmware/targets/stage_counter.hpp"
#include "firmware/targets/text.hpp"
#include "tests/target/cost_scene.hpp"
#include "tests/target/cost_search.hpp"

namespace s4tp::targets {
namespace {

constexpr std::uint32_t kProgress = 200;  // scenes from one report to the next

planner::Planner planner;
bool charges = false;     // prints them
std::int32_t unit = 160;  // counts

class Meter final : public planner::Probe {
 public:
  void stage_begin(planner::Stage stage) override { counter_.stage_begin(stage); }
  void stage_end(planner::Stage stage) override { counter_.stage_end(stage); }
  void cycle_done(const scene::Scene& scene, const satp::PredictionSet& prediction,
                  const sadrf::RiskProfile& risk) override {
    counter_.cycle_done(scene, prediction, risk);
    Text text;
    text << "charged";
    for (int i = 0; i < StageCounter::kRows; ++i) {
      const std::uint32_t took = counter_.row(i).last;
      const std::int32_t charged = charged_for(i);
      text << " " << charged << "/" << took;
      note(cost.rows[i], took);
      note(cost.rows[StageCounter::kRows + i],
           test::kNothingShort + took - static_cast<std::uint32_t>(charged * unit));
    }
    text << "\n";
    if (charges) print(text.c_str());
  }
  test::Cost cost;

 private:
  static void note(std::uint32_t& most, std::uint32_t count) {
    if (count > most) most = count;
  }
  static std::int32_t charged_for(int row) {
    if (row == planner::kStageCount) return planner.allowance.cycle - planner.work().left();
    return planner.work().spent(static_cast<planner::Stage>(row));
  }

  StageCounter counter_;
};

test::CostScene scene;  // not on the small stack
Plan plan;
planner::Explanation explanation;
test::CostSearch search(1);
std::uint32_t measured = 0;

test::Cost measure(const test::Genome& genome) {
  scene.make(genome);
  Meter meter;
  planner.probe = &meter;
  if (planner.init(Parameters{}) != Status::kOk) return {};
  for (int cycle = 0; cycle < test::kSceneCycles; ++cycle) {
    if (cycle > 0) scene.advance(plan);
    (void)planner.plan(scene.input(), plan, explanation);
  }
  ++measured;
  return meter.cost;
}

void print_genome(const test::Genome& genome) {
  constexpr int kPiece = 31;
  for (int i = 0; i < test::kGenes; i += kPiece) {
    Text text;
    for (int j = i; j < i + kPiece && j < test::kGenes; ++j) text.hex(genome.genes[j], 2);
    print(text.c_str());
  }
  print("\n");
}

/// Of a row's count.
std::int32_t signed_count(int row, std::uint32_t count) {
  return static_cast<std::int32_t>(row < StageCounter::kRows ? count : count - test::kNothingShort);
}

void print_best() {
  for (int row = 0; row < test::kCostRows; ++row) {
    Text text;
    const bool beyond = row >= StageCounter::kRows;
    text << (beyond ? "short " : "best ") << StageCounter::name(beyond ? row - StageCounter::kRows : row)
         << " " << signed_count(row, search.best(row).count) << " of " << measured << " ";
    print(text.c_str());
    print_genome(search.best(row).genome);
  }
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

/// After "scene ". The last genes may be missing: they are 0. \return false when it is not a genome
bool parse(const char* text, int size, test::Genome& genome) {
  if (size % 2 != 0 || size > 2 * test::kGenes) return false;
  for (int i = 0; 2 * i < size; ++i) {
    const int high = hex_digit(text[2 * i]);
    const int low = hex_digit(text[2 * i + 1]);
    if (high < 0 || low < 0) return false;
    genome.genes[i] = static_cast<std::uint8_t>(16 * high + low);
  }
  return true;
}

std::uint32_t number(const char*& text) {
  std::uint32_t value = 0;
  while (*text == ' ') ++text;
  for (; *text >= '0' && *text <= '9'; ++text) value = 10 * value + static_cast<std::uint32_t>(*text - '0');
  return value;
}

bool starts_with(const char* text, const char* start) {
  while (*start != '\0' && *text == *start) ++text, ++start;
  return *start == '\0';
}

bool obey(const char* line, int size) {
  constexpr int kUnit = 5;
  constexpr int kScene = 6;
  constexpr int kSearch = 7;
  if (starts_with(line, "scene ")) {
    test::Genome genome;
    if (!parse(line + kScene, size - kScene, genome)) return false;
    const test::Cost cost = measure(genome);
    search.take(genome, cost);
    Text text;
    text << "cost";
    for (int row = 0; row < test::kCostRows; ++row) text << " " << signed_count(row, cost.rows[row]);
    text << "\n";
    print(text.c_str());
    return true;
  }
  if (starts_with(line, "uncapped")) {
    constexpr std::int32_t kBoundless = 100'000'000;
    planner.allowance.cycle = planner.allowance.ranking = planner.allowance.exact_risk = kBoundless;
    return true;
  }
  if (starts_with(line, "unit ")) {
    const char* rest = line + kUnit;
    unit = static_cast<std::int32_t>(number(rest));
    return unit > 0;
  }
  if (starts_with(line, "charges")) {
    charges = true;
    return true;
  }
  if (!starts_with(line, "search ")) return size == 0 || line[0] == '#';
  const char* rest = line + kSearch;
  search.seed(number(rest));
  for (std::uint32_t left = number(rest); left > 0; --left) {
    const test::Genome genome = search.propose();
    search.take(genome, measure(genome));
    if (measured % kProgress == 0) print_best();
  }
  print_best();
  return true;
}

}  // namespace

int run(const char* log, bool) {  // the log is the script
  static char chunk[1024];
  static char line[1024];
  const int handle = log == nullptr ? -1 : open_for_reading(log);
  if (handle < 0) {
    print("cannot open the script\n");
    return 2;
  }
  int size = 0;
  for (;;) {
    const int got = read(handle, chunk, sizeof chunk);
    if (got <= 0) return got < 0 ? 2 : 0;
    for (int i = 0; i < got; ++i) {
      if (chunk[i] != '\n' && size + 1 < static_cast<int>(sizeof line)) {
        line[size++] = chunk[i];
        continue;
      }
      line[size] = '\0';
      if (!obey(line, size)) {
        print("not a command: ");
        print(line);
        print("\n");
        return 2;
      }
      size = 0;
    }
  }
}

}  // namespace s4tp::targets
