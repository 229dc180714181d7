// JSON records of campaigns: an episode file, and a document that is compared. Refused with a reason, or figures to report.

#include <cmath>
#include <nlohmann/json.hpp>

#include "sim_host/campaign/compare.hpp"
#include "sim_host/campaign/episode_record.hpp"
#include "sim_host/campaign/record_limits.hpp"
#include "sim_host/campaign/records.hpp"
#include "tests/fuzz/files.hpp"

using namespace s4tp;
using namespace s4tp::campaign;
using fuzz::expect;
using nlohmann::ordered_json;

namespace {

void check(const Records& records) {
  expect(!records.headers.empty() && !records.cells.empty(), "a record has a header with cells");
  for (const ReportedCell& cell : records.cells) {
    expect(cell.planned >= cell.result.episodes.size(), "no episode that was not planned");
    const auto first = records.headers[0].at("first_seed").get<std::uint64_t>();
    for (const metrics::EpisodeMetrics& episode : cell.result.episodes) {
      expect(episode.seed >= first && episode.seed - first < cell.planned, "each was planned");
      expect(episode.seed <= kSeedMax && episode.duration_s >= 0.0 && episode.duration_s <= kDurationMax_s &&
                 std::abs(episode.min_gap_m) <= kFigureMax && episode.collisions_at_fault >= 0,
             "figures are in their ranges");
      const EpisodeRow row{cell.result.cell, episode};
      expect(to_json(row_of(to_json(row))) == to_json(row), "what is written is read back");
    }
    expect(!replay_command(records.headers[0], cell.result.cell, 1).empty(),
           "an episode can be driven again");
  }
  if (!records.headers[0].at("parameters").get<std::string>().empty()) return;  // another file
  const CampaignPlan plan = plan_of(records.headers[0]);
  expect(plan.episodes >= 1 && !plan.planners.empty(), "a header is a plan");
  expect(difference(records.headers[0], records.headers[0]).empty(), "a header is like itself");
}

/// Errors of documents name what in them is wrong; of which file, their caller adds.
void compare(const std::string& text) {
  try {
    const std::vector<Outcomes> outcomes = outcomes_of(parse_json(text));
    std::uint64_t episodes = 0;
    for (const Outcomes& cell : outcomes) episodes += cell.failed.size();
    expect(episodes <= kComparedMax, "no more episodes than are compared");
    if (episodes > 10'000) return;
    expect(comparison_json(pair_up(outcomes, "", outcomes, "")).is_array(), "a comparison is a list");
  } catch (const std::exception& error) {
    expect(*error.what() != '\0', "an error says what is wrong");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  const auto file = fuzz::folder().write("fuzz.jsonl", text.ends_with('\n') ? text : text + '\n');
  static_cast<void>(fuzz::accepts("fuzz.jsonl", [&] { check(read_records({file})); }));
  compare(text);
  return 0;
}
