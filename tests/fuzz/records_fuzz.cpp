// JSON records of campaigns: an episode file, or a folder of two (a form feed parts them), and a document that is compared.
// Refused with a reason, or figures to report; what was read can be written and gone on with.

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

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
    for (const metrics::EpisodeMetrics& episode : cell.result.episodes) {
      expect(std::any_of(records.headers.begin(), records.headers.end(),
                         [&](const ordered_json& header) {
                           const auto first = header.at("first_seed").get<std::uint64_t>();
                           return episode.seed >= first &&
                                  episode.seed - first < header.at("episodes").get<std::uint64_t>();
                         }),
             "each was planned");
      expect(episode.seed <= kSeedMax && episode.duration_s >= 0.0 && episode.duration_s <= kDurationMax_s &&
                 std::abs(episode.min_gap_m) <= kFigureMax && episode.collisions_at_fault >= 0,
             "figures are in their ranges");
      const EpisodeRow row{cell.result.cell, episode};
      expect(to_json(row_of(to_json(row))) == to_json(row), "what is written is read back");
    }
    expect(!replay_command(records.headers[0], cell.result.cell, 1).empty(),
           "an episode can be driven again");
  }
  expect(records.done() <= records.planned(), "no more episodes than were planned");
  if (!records.headers[0].at("parameters").get<std::string>().empty()) return;  // another file
  const CampaignPlan plan = plan_of(records.headers[0]);
  expect(plan.episodes >= 1 && !plan.planners.empty(), "a header is a plan");
  expect(difference(records.headers[0], records.headers[0]).empty(), "a header is like itself");
}

/// The same record written by this program, and gone on with: nothing is lost, nothing is added.
void write_again(const std::filesystem::path& file, const Part& part) {
  const auto again = fuzz::folder().path() / "again.part";
  std::filesystem::remove(again);
  {
    EpisodeRecord record(again, part.header);
    for (const EpisodeRow& row : part.rows) record.append(row);
  }
  expect(EpisodeRecord(again, part.header).found().size() == part.rows.size(), "all are found again");
  const Part written = read_part(again);
  expect(written.header == part.header && written.rows.size() == part.rows.size(),
         "a record is read as it was written");
  expect(records_of(part.header, part.rows).done() == read_records({file}).done(),
         "a campaign just driven has the episodes of its record");
}

/// Errors of documents name what in them is wrong; of which file, their caller adds.
void compare(const std::string& text) {
  try {
    const std::vector<Outcomes> outcomes = outcomes_of(parse_json(text));
    std::uint64_t episodes = 0;
    for (const Outcomes& cell : outcomes) episodes += cell.failed.size();
    expect(episodes <= kComparedMax, "no more episodes than are compared");
    if (episodes > 10'000) return;
    const std::vector<ComparedCell> compared = pair_up(outcomes, "", outcomes, "");
    expect(comparison_json(compared).is_array(), "a comparison is a list");
    std::ostringstream printed;
    print_comparison(printed, compared, "first", "second");
    expect(!printed.str().empty(), "a comparison can be read");
  } catch (const std::exception& error) {
    expect(*error.what() != '\0', "an error says what is wrong");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  const std::size_t parted = text.find('\f');
  const std::string first = text.substr(0, parted);
  const auto& folder = fuzz::folder();
  const auto file = folder.write("fuzz.jsonl", first.ends_with('\n') ? first : first + '\n');
  static_cast<void>(fuzz::accepts("fuzz.jsonl", [&] {
    const Records records = read_records({file});
    check(records);
    for (const ReportedCell& cell : records.cells) {
      expect(outcomes_of(cell.result).failed.size() == cell.result.episodes.size(), "each has an outcome");
    }
    write_again(file, read_part(file));
  }));
  if (parted != std::string::npos) {
    const auto other = folder.write("other.jsonl", text.substr(parted + 1));
    static_cast<void>(fuzz::accepts("", [&] { check(read_records({folder.path()})); }));
    static_cast<void>(fuzz::accepts("jsonl", [&] { EpisodeRecord(file, read_part(other).header); }));
  }
  compare(text);
  return 0;
}
