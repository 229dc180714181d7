#include "sim_host/view/report.hpp"

#include <fstream>
#include <sstream>
#include <stdexcept>

#include "sim_host/campaign/table.hpp"

namespace s4tp::view {
namespace {

const char* const kHead = R"(<!doctype html>
<meta charset="utf-8">
<title>s4tp: how it drove</title>
<style>
  body { font: 15px/1.5 sans-serif; margin: 2em auto; max-width: 1240px; color: #222 }
  pre { background: #f4f4f0; padding: 1em; overflow-x: auto; font-size: 12.5px }
  h2 { margin-top: 2em }
  .episodes { display: grid; grid-template-columns: repeat(auto-fill, minmax(290px, 1fr)); gap: 12px }
  figure { margin: 0; border: 1px solid #ddd; border-top: 4px solid #7a9e58 }
  figure.bad { border-top-color: #c0392b }
  figure img { width: 100%; display: block }
  figcaption { font-size: 12px; padding: 4px 8px }
</style>
<h1>s4tp: how it drove</h1>
<p>Every number comes from the recorded state of the world, none from a planner's opinion. "ours" counts collisions
attributed to the ego by a fixed table. Pictures show each episode's tensest moment: orange the plan, blue the
predictions, red haze the driving risk field.</p>
)";

}  // namespace

std::string picture_name(const std::string& scenario, const std::string& planner, std::uint64_t seed) {
  return scenario + "_" + planner + "_" + std::to_string(seed) + ".svg";
}

void write_report(const std::filesystem::path& folder, const std::vector<campaign::EpisodeRow>& rows) {
  const std::filesystem::path file = folder / "index.html";
  std::ofstream out(file);
  std::ostringstream table;
  campaign::print_table(table, campaign::collect(rows));
  out << kHead << "<pre>" << table.str() << "</pre>\n";

  std::string heading;
  for (const campaign::EpisodeRow& row : rows) {
    const std::string picture = picture_name(row.cell.scenario, row.cell.planner, row.metrics.seed);
    if (!std::filesystem::exists(folder / picture)) continue;
    const std::string wanted = row.cell.planner + ": " + row.cell.scenario;
    if (wanted != heading) {
      if (!heading.empty()) out << "</div>\n";
      out << "<h2>" << wanted << "</h2>\n<div class='episodes'>\n";
      heading = wanted;
    }
    const bool good = row.metrics.ending == world::Ending::kGoal;
    out << "<figure" << (good ? "" : " class='bad'") << "><a href='" << picture
        << "'><img loading='lazy' src='" << picture << "'></a><figcaption>seed " << row.metrics.seed << ": "
        << metrics::ending_name(row.metrics.ending) << " after " << row.metrics.duration_s
        << " s</figcaption></figure>\n";
  }
  if (!heading.empty()) out << "</div>\n";
  if (!out) throw std::runtime_error(file.string() + ": cannot write the report");
}

}  // namespace s4tp::view
