#include "sim_host/view/charts.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "sim_host/metrics/summary.hpp"
#include "sim_host/view/html.hpp"

namespace s4tp::view {
namespace {

using campaign::CellResult;
using metrics::EpisodeMetrics;

constexpr double kLabelPx = 150.0;
constexpr double kPanelPx = 290.0;
constexpr double kBetweenPx = 44.0;
constexpr double kCountPx = 64.0;  // beside the first panel
constexpr double kLinePx = 13.0;
constexpr double kHeadPx = 34.0;
constexpr double kGapShownM = 10.0;

/// One of the three columns.
struct Panel {
  double left_px;
  double most;  // at its right end
  double step;  // between grid lines
  std::string title;
  [[nodiscard]] double x(double value) const {
    return left_px + kPanelPx * std::clamp(value / most, 0.0, 1.0);
  }
};

std::string text(double x, double y, const std::string& anchor, const std::string& words,
                 const char* more = "") {
  return format("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\" %s>", x, y, anchor.c_str(), more) +
         escaped(words) + "</text>\n";
}

std::string line(double x1, double y1, double x2, double y2, const std::string& colour, double width) {
  return format(
      "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"%s\" stroke-width=\"%.1f\"/>\n", x1, y1,
      x2, y2, colour.c_str(), width);
}

std::string colour_of(const CellResult& cell) {
  return cell.cell.planner == "s4tp" ? "var(--bad)" : "var(--accent)";
}

std::string interval_mark(const CellResult& cell, const Panel& panel, double y) {
  const metrics::Rate& rate = cell.summary.success;
  const std::string colour = colour_of(cell);
  return line(panel.x(100.0 * rate.interval.low), y, panel.x(100.0 * rate.interval.high), y, colour, 1.6) +
         format("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"4\" fill=\"%s\" stroke=\"%s\" stroke-width=\"1.6\"/>\n",
                panel.x(100.0 * rate.share), y, cell.cell.guarded ? colour.c_str() : "var(--card)",
                colour.c_str());
}

/// 5 to 95 % a thin line, 25 to 75 % a box, the median a stroke.
std::string box_mark(const CellResult& cell, const std::vector<double>& values, const Panel& panel,
                     double y) {
  if (values.empty()) return {};
  const auto at = [&](double share) { return panel.x(metrics::percentile(values, share)); };
  const std::string colour = colour_of(cell);
  return line(at(0.05), y, at(0.95), y, colour, 1.2) +
         format(
             "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"7\" rx=\"2\" fill=\"%s\" stroke=\"%s\" "
             "stroke-width=\"1.4\"/>\n",
             at(0.25), y - 3.5, std::max(at(0.75) - at(0.25), 1.0),
             cell.cell.guarded ? colour.c_str() : "var(--card)", colour.c_str()) +
         line(at(0.5), y - 4.5, at(0.5), y + 4.5, "var(--ink)", 1.8);
}

std::vector<double> goal_times(const CellResult& cell) {
  std::vector<double> values;
  for (const EpisodeMetrics& episode : cell.episodes) {
    if (episode.ending == traffic::Ending::kGoal) values.push_back(episode.duration_s);
  }
  return values;
}

std::vector<double> gaps(const CellResult& cell) {
  std::vector<double> values;
  for (const EpisodeMetrics& episode : cell.episodes) values.push_back(episode.min_gap_m);
  return values;
}

std::string tooltip(const CellResult& cell) {
  const metrics::Summary& s = cell.summary;
  std::string words = campaign::words(cell.cell) +
                      format(": %d of %d reach the goal, 95 %% interval %.1f to %.1f %%", s.success.count,
                             s.episodes, 100.0 * s.success.interval.low, 100.0 * s.success.interval.high);
  const auto add = [&](const char* name, const char* unit, const std::vector<double>& values) {
    if (values.empty()) return;
    words +=
        format("; %s: median %.2f %s, 5 to 95 %%: %.2f to %.2f %s", name, metrics::percentile(values, 0.5),
               unit, metrics::percentile(values, 0.05), metrics::percentile(values, 0.95), unit);
  };
  add("time to goal", "s", goal_times(cell));
  add("smallest gap", "m", gaps(cell));
  return "<title>" + escaped(words) + "</title>";
}

/// Names in the order they first come.
std::vector<std::string> names(const Cells& cells, std::string campaign::Cell::*name) {
  std::vector<std::string> found;
  for (const CellResult* const cell : cells) {
    if (std::find(found.begin(), found.end(), cell->cell.*name) == found.end())
      found.push_back(cell->cell.*name);
  }
  return found;
}

/// The three panels of a row, side by side.
struct Panels {
  Panel success;
  Panel time;
  Panel gap;

  [[nodiscard]] double width_px() const { return gap.left_px + kPanelPx + 16.0; }
};

Panels panels_for(const Cells& cells) {
  double longest_s = 10.0;
  for (const CellResult* const cell : cells) {
    const std::vector<double> times_s = goal_times(*cell);
    if (!times_s.empty()) longest_s = std::max(longest_s, metrics::percentile(times_s, 0.95));
  }
  const double step_s = longest_s > 200.0  ? std::ceil(longest_s / 1000.0) * 100.0
                        : longest_s > 40.0 ? 20.0
                        : longest_s > 20.0 ? 10.0
                                           : 5.0;
  const Panel success{kLabelPx, 100.0, 25.0, "reaches the goal [%]"};
  const Panel time{success.left_px + kPanelPx + kCountPx + kBetweenPx, std::ceil(longest_s / step_s) * step_s,
                   step_s, "time to goal [s], those that reach it"};
  const Panel gap{time.left_px + kPanelPx + kBetweenPx, kGapShownM, 2.0,
                  format("smallest gap [m], all; %.0f: and more", kGapShownM)};
  return {success, time, gap};
}

std::string row_of(const CellResult& cell, const Panels& panels, double top_px) {
  const double middle = top_px + kLinePx / 2;
  return "<g>" + tooltip(cell) +
         format("<rect x=\"0\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" fill=\"transparent\"/>\n", top_px,
                panels.width_px(), kLinePx) +
         interval_mark(cell, panels.success, middle) +
         text(panels.success.left_px + kPanelPx + kCountPx, middle + 4.0, "end",
              format("%d/%d", cell.summary.success.count, cell.summary.episodes),
              "class=\"soft\" font-size=\"11\"") +
         box_mark(cell, goal_times(cell), panels.time, middle) +
         box_mark(cell, gaps(cell), panels.gap, middle) + "</g>\n";
}

/// Titles, and a line for each step, behind rows from `top_px` to `bottom_px`.
std::string scales(const Panels& panels, double top_px, double bottom_px) {
  std::string drawn;
  for (const Panel& panel : {panels.success, panels.time, panels.gap}) {
    drawn += text(panel.left_px, top_px - 18.0, "start", panel.title, "class=\"soft\" font-size=\"11\"");
    for (double value = 0.0; value <= panel.most + 1e-9; value += panel.step) {
      drawn += line(panel.x(value), top_px - 2.0, panel.x(value), bottom_px, "var(--line)", 1.0);
      drawn += text(panel.x(value), top_px - 5.0, "middle", format("%.0f", value),
                    "class=\"soft\" font-size=\"10\"");
    }
  }
  return drawn;
}

/// One scenario's rows, by planner, guarded ones first. \param y_px  advanced by its height
std::string scenario_rows(const std::string& scenario, const Cells& cells, const Panels& panels,
                          double& y_px) {
  const double top = y_px + kHeadPx;
  double row = top;
  std::string marks;
  for (const std::string& planner : names(cells, &campaign::Cell::planner)) {
    const double begin = row;
    for (const bool guarded : {true, false}) {
      for (const CellResult* const cell : cells) {
        if (cell->cell.planner != planner || cell->cell.guarded != guarded) continue;
        marks += row_of(*cell, panels, row);
        row += kLinePx;
      }
    }
    marks += text(kLabelPx - 12.0, (begin + row) / 2 + 4.0, "end", planner,
                  planner == "s4tp" ? "font-weight=\"600\"" : "");
    row += 5.0;
  }
  const std::string title = text(0.0, y_px + 14.0, "start", scenario, "font-weight=\"600\" font-size=\"14\"");
  y_px = row + 14.0;
  return title + scales(panels, top, row) + marks;
}

}  // namespace

std::string outcome_chart(const Cells& cells) {
  const Panels panels = panels_for(cells);
  std::string body;
  double y = 8.0;
  for (const std::string& scenario : names(cells, &campaign::Cell::scenario)) {
    Cells here;
    std::copy_if(cells.begin(), cells.end(), std::back_inserter(here),
                 [&](const CellResult* cell) { return cell->cell.scenario == scenario; });
    body += scenario_rows(scenario, here, panels, y);
  }
  return format(
             "<svg viewBox=\"0 0 %.0f %.0f\" width=\"%.0f\" font-size=\"12\" role=\"img\" "
             "aria-label=\"success, "
             "time to goal and smallest gap by scenario and planner\">\n",
             panels.width_px(), y, panels.width_px()) +
         body + "</svg>\n";
}

}  // namespace s4tp::view
