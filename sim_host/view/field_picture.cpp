#include "sim_host/view/field_picture.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "algo/sadrf/field.hpp"
#include "sim_host/view/svg.hpp"

namespace s4tp::view {
namespace {

using map::Vec2;

constexpr float kWheelbaseM = 2.9F;
constexpr float kWidthM = 1.8F;
constexpr float kLengthM = 5.0F;
constexpr float kOverhangM = 1.0F;
constexpr float kSpeeds[] = {5.0F, 10.0F, 15.0F};
constexpr float kSteeringsDeg[] = {-6.0F, 0.0F, 3.0F, 6.0F, 12.0F};

// A panel, in metres of the driver's frame (x ahead, drawn to the right).
constexpr double kBehindM = 8.0;
constexpr double kAheadM = 60.0;
constexpr double kRightM = 30.0;
constexpr double kLeftM = 40.0;
constexpr double kCellM = 0.5;
constexpr double kScale = 3.4;  // pixels per metre
constexpr double kPanelWidth = (kBehindM + kAheadM) * kScale;
constexpr double kPanelHeight = (kRightM + kLeftM) * kScale;
constexpr double kGap = 10.0;
constexpr double kMarginLeft = 92.0;
constexpr double kMarginTop = 78.0;
constexpr double kMarginBottom = 96.0;

/// Density from which a colour holds: three steps a decade, light to dark red.
struct Band {
  float from;
  const char* label;
  const char* colour;
};
constexpr Band kBands[] = {{0.01F, "0.01", "#fff0e6"}, {0.03F, "0.03", "#fedcc5"}, {0.1F, "0.1", "#fdbe9b"},
                           {0.3F, "0.3", "#fc9a72"},   {1.0F, "1", "#f6694a"},     {3.0F, "3", "#d73027"},
                           {10.0F, "10", "#96101f"}};
constexpr int kBandCount = 7;

int band_of(float density) {
  int band = -1;
  while (band + 1 < kBandCount && density >= kBands[band + 1].from) ++band;
  return band;
}

std::string number(double value, int digits = 0) {
  std::ostringstream text;
  text.setf(std::ios::fixed);
  text.precision(digits);
  text << value;
  return text.str();
}

struct Panel {
  Svg& svg;
  double left_px;
  double top_px;

  [[nodiscard]] Vec2 px(double x_m, double y_m) const {
    return {left_px + (x_m + kBehindM) * kScale, top_px + (kLeftM - y_m) * kScale};
  }

  void fill(const sadrf::Field& field) const {
    std::vector<std::ostringstream> runs(kBandCount);
    for (double y = -kRightM + kCellM / 2; y < kLeftM; y += kCellM) {
      int running = -1;
      double since = 0.0;
      for (double x = -kBehindM; x <= kAheadM; x += kCellM) {
        const Point centre = {static_cast<float>(x + kCellM / 2), static_cast<float>(y)};
        const int band = x < kAheadM ? band_of(sadrf::field_at(field, centre)) : -1;
        if (band == running) continue;
        if (running >= 0) {
          const Vec2 from = px(since, y);
          auto& run = runs[static_cast<std::size_t>(running)];
          run << 'M' << number(from.x, 1) << ' ' << number(from.y, 1) << 'h'
              << number((x - since) * kScale, 1);
        }
        running = band;
        since = x;
      }
    }
    for (std::size_t i = 0; i < runs.size(); ++i) {
      // A little more than a row, so that no seam shows.
      if (!runs[i].str().empty()) svg.path_px(runs[i].str(), kBands[i].colour, kCellM * kScale + 0.3);
    }
  }

  void draw_path(const sadrf::Field& field) const {
    std::vector<Vec2> path;
    const double kappa = static_cast<double>(field.curvature_1pm);
    // The field ends where half a circle is driven.
    const double length = std::min(static_cast<double>(field.look_ahead_m),
                                   std::numbers::pi / std::max(std::fabs(kappa), 1e-6));
    for (int i = 0; i <= 60; ++i) {
      const double s = length * i / 60.0;
      const bool straight = std::fabs(kappa) < 1e-6;
      const double x = straight ? s : std::sin(kappa * s) / kappa;
      const double y = straight ? 0.0 : (1.0 - std::cos(kappa * s)) / kappa;
      if (x < -kBehindM || x > kAheadM || y > kLeftM || y < -kRightM) break;
      path.push_back(px(x, y));
    }
    svg.line_px(path, "#2d6da3", 1.0);
  }

  void draw_car() const {
    const Vec2 corner = px(-static_cast<double>(kOverhangM), static_cast<double>(kWidthM) / 2);
    svg.rectangle_px(corner.x, corner.y, static_cast<double>(kLengthM) * kScale,
                     static_cast<double>(kWidthM) * kScale, "#333");
  }

  void draw_frame(bool leftmost, bool lowest) const {
    const Vec2 low = px(-kBehindM, -kRightM);
    const Vec2 high = px(kAheadM, kLeftM);
    svg.line_px({low, {high.x, low.y}, high, {low.x, high.y}, low}, "#888", 1.0);
    for (int x = 0; x <= 60; x += 20) {
      const Vec2 at = px(x, -kRightM);
      svg.line_px({at, {at.x, at.y - 4}}, "#888", 1.0);
      if (lowest) svg.text_px(at.x - (x == 0 ? 3 : 6), at.y + 13, std::to_string(x), 11, "#444");
    }
    for (int y = -20; y <= 40; y += 20) {
      const Vec2 at = px(-kBehindM, y);
      svg.line_px({at, {at.x + 4, at.y}}, "#888", 1.0);
      if (leftmost) svg.text_px(at.x - 24, at.y + (y == 40 ? 9 : 4), std::to_string(y), 11, "#444");
    }
  }
};

void draw_legend(Svg& svg, double left_px, double top_px) {
  svg.text_px(left_px, top_px - 6, "risk density G [1], from", 12);
  for (int i = 0; i < kBandCount; ++i) {
    svg.rectangle_px(left_px + 46.0 * i, top_px, 46.0, 14.0, kBands[i].colour);
    svg.text_px(left_px + 46.0 * i + 2, top_px + 27, kBands[i].label, 11, "#444");
  }
}

}  // namespace

void draw_field_grid(sadrf::FieldPreset preset, const std::filesystem::path& file) {
  const bool paper = preset == sadrf::FieldPreset::kPaper;
  const sadrf::FieldParams params = paper ? sadrf::paper_preset(kWidthM) : sadrf::kolekar2020_preset(kWidthM);
  const double columns = static_cast<double>(std::size(kSteeringsDeg));
  const double rows = static_cast<double>(std::size(kSpeeds));
  const double width = kMarginLeft + columns * (kPanelWidth + kGap) + 6.0;
  const double grid_bottom = kMarginTop + rows * (kPanelHeight + kGap) - kGap;
  Svg svg({0.0, 0.0}, {width, grid_bottom + kMarginBottom}, 1.0, 0.0);
  svg.text_px(
      kMarginLeft, 24,
      std::string("Driving risk field over speed and steering, preset ") + (paper ? "paper" : "kolekar2020"),
      17);
  svg.text_px(
      kMarginLeft, 44,
      "p = 0.0064, t_la = 3.5 s, m = " + number(static_cast<double>(params.widening), 3) +
          ", k1 = " + number(static_cast<double>(params.widening_inner), 1) +
          ", k2 = " + number(static_cast<double>(params.widening_outer), 2) +
          ", c = 0.45 m, wheelbase 2.9 m; blue: the path, to the look-ahead distance or half a circle",
      12, "#444");
  for (std::size_t row = 0; row < std::size(kSpeeds); ++row) {
    const double top = kMarginTop + static_cast<double>(row) * (kPanelHeight + kGap);
    svg.text_px(8, top + kPanelHeight / 2, number(static_cast<double>(kSpeeds[row])) + " m/s", 14);
    for (std::size_t column = 0; column < std::size(kSteeringsDeg); ++column) {
      const double left = kMarginLeft + static_cast<double>(column) * (kPanelWidth + kGap);
      if (row == 0) {
        const std::string sign = kSteeringsDeg[column] > 0.0F   ? " left"
                                 : kSteeringsDeg[column] < 0.0F ? " right"
                                                                : "";
        svg.text_px(
            left + kPanelWidth / 2 - 40, top - 8,
            "steering " + number(std::fabs(static_cast<double>(kSteeringsDeg[column]))) + "\u00b0" + sign,
            13);
      }
      const float steering = kSteeringsDeg[column] * std::numbers::pi_v<float> / 180.0F;
      const sadrf::Field field = sadrf::prepare_field(
          params, sadrf::DriverState{{0.0F, 0.0F, 0.0F}, kSpeeds[row], steering, kWheelbaseM});
      svg.rectangle_px(left, top, kPanelWidth, kPanelHeight, "#ffffff");
      const Panel panel{svg, left, top};
      panel.fill(field);
      panel.draw_path(field);
      panel.draw_car();
      panel.draw_frame(column == 0, row + 1 == std::size(kSpeeds));
    }
  }
  svg.text_px(kMarginLeft + kPanelWidth / 2 - 60, grid_bottom + 30, "ahead of the rear axle [m]", 12, "#444");
  svg.text_px(8, kMarginTop - 8, "left of it [m]", 12, "#444");
  draw_legend(svg, kMarginLeft + 2.5 * (kPanelWidth + kGap), grid_bottom + 42);
  svg.save(file);
}

}  // namespace s4tp::view
