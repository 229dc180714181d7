#include <algorithm>
#include <cctype>

#include "sim_host/view/html.hpp"
#include "sim_host/view/replay.hpp"

namespace s4tp::view {
namespace {

std::string fact(const std::string& value, const std::string& name) {
  return "<div><b>" + escaped(value) + "</b>" + name + "</div>";
}

}  // namespace

std::string replay_name(const campaign::Cell& cell, std::uint64_t seed) {
  std::string name = cell.scenario + "_" + cell.planner + (cell.guarded ? "" : "_bare") + "_" + cell.flavour +
                     "_" + cell.traffic + "_" + cell.perception + "_" + std::to_string(seed) + ".html";
  std::replace_if(
      name.begin(), name.end(),
      [](unsigned char c) { return std::isalnum(c) == 0 && c != '_' && c != '.' && c != '-'; }, '-');
  return name;
}

void write_replay(const Replayed& episode, const std::filesystem::path& file) {
  const metrics::EpisodeMetrics& m = episode.row.metrics;
  const std::string who = campaign::words(episode.row.cell);
  const bool good = m.ending == traffic::Ending::kGoal;
  std::string ending = metrics::ending_name(m.ending);
  if (m.ending == traffic::Ending::kCollision) {
    ending += ": " + m.cause + (m.collisions_at_fault > 0 ? " (our fault)" : " (not our fault)");
  }
  Page page;
  page.title = who + ", seed " + std::to_string(m.seed) + ": " + ending;
  page.body = "<h1>" + escaped(who) + ", seed " + std::to_string(m.seed) + "</h1>\n<div class=\"figures\">" +
              "<div><b class=\"" + (good ? "good" : "bad") + "\">" + escaped(ending) +
              "</b>how it ended</div>" + fact(format("%.2f s", m.duration_s), "after take-over") +
              fact(format("%.2f m", m.min_gap_m), "smallest gap") +
              fact(format("%.2f s", m.min_time_to_collision_s), "smallest time to collision (10: more)") +
              fact(format("%.2f m/s³", m.mean_abs_jerk_mps3), "mean |jerk|") + "</div>\n";
  if (episode.recorded) {
    const std::string differs = changed(*episode.recorded, episode.row);
    page.body +=
        differs.empty()
            ? "<p id=\"check\"><b class=\"good\">✓ Replays to the same frame:</b> driven again from its "
              "seed, every number recorded of it came out again to the bit.</p>\n"
            : "<p id=\"check\"><b class=\"bad\">✗ This is not the drive that was recorded:</b> " +
                  escaped(differs) + "</p>\n";
  }
  page.body += "<p class=\"soft\">Drive it again: <code>" + escaped(episode.command) + "</code></p>\n";
  page.body += kReplayHtml;
  page.data = replay_data(episode).dump();
  page.scripts = {kCanvasJs, kSceneJs, kReplaySceneJs, kReplayJs};
  write_page(page, file);
}

}  // namespace s4tp::view
