#include "sim_host/train/learning_curve.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace s4tp::train {
namespace {

constexpr double kWidth = 720.0;
constexpr double kHeight = 300.0;
constexpr double kLeft = 56.0;
constexpr double kTop = 16.0;
constexpr double kBottom = 40.0;
constexpr double kRight = 170.0;
constexpr int kGridLines = 4;

struct Line {
  const char* name;
  const char* colour;
  double (*value)(const CurvePoint&);
};
constexpr std::array<Line, 4> kLines{{
    {"loss, training", "#1f77b4",
     [](const CurvePoint& point) {
       return point.position + point.mode + point.route + point.yields + point.ego;
     }},
    {"loss, validation", "#d62728", [](const CurvePoint& point) { return point.validation; }},
    {"likeliest mode [m]", "#2ca02c", [](const CurvePoint& point) { return point.top_1_m; }},
    {"nearest mode [m]", "#9467bd", [](const CurvePoint& point) { return point.best_of_modes_m; }},
}};

std::ofstream opened(const std::filesystem::path& file) {
  std::ofstream out(file);
  if (!out) throw std::runtime_error(file.string() + " cannot be written");
  return out;
}

}  // namespace

void write_curve(const std::vector<CurvePoint>& curve, const std::filesystem::path& file) {
  nlohmann::ordered_json points = nlohmann::ordered_json::array();
  for (const CurvePoint& point : curve) {
    points.push_back({{"step", point.step},
                      {"position", point.position},
                      {"mode", point.mode},
                      {"route", point.route},
                      {"yields", point.yields},
                      {"ego", point.ego},
                      {"gradient", point.gradient},
                      {"rate", point.rate},
                      {"validation", point.validation},
                      {"top_1_m", point.top_1_m},
                      {"best_of_modes_m", point.best_of_modes_m}});
  }
  opened(file) << nlohmann::ordered_json{{"points", points}}.dump(1) << '\n';
}

void draw_curve(const std::vector<CurvePoint>& curve, const std::filesystem::path& file) {
  if (curve.size() < 2) return;
  double highest = 0.0;
  for (const CurvePoint& point : curve) {
    for (const Line& line : kLines) highest = std::max(highest, line.value(point));
  }
  const double last = static_cast<double>(curve.back().step);
  const auto x = [&](double step) { return kLeft + (kWidth - kLeft - kRight) * step / last; };
  const auto y = [&](double value) {
    return kHeight - kBottom - (kHeight - kTop - kBottom) * value / highest;
  };
  std::ofstream out = opened(file);
  out << "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 " << kWidth << ' ' << kHeight
      << "' font-family='sans-serif' font-size='11'>\n<rect width='100%' height='100%' fill='white'/>\n";
  for (int i = 0; i <= kGridLines; ++i) {
    const double value = highest * i / kGridLines;
    out << "<path d='M" << x(0) << ' ' << y(value) << 'H' << x(last) << "' stroke='#ddd'/><text x='"
        << kLeft - 6 << "' y='" << y(value) + 4 << "' text-anchor='end'>"
        << static_cast<int>(value * 100.0 + 0.5) / 100.0 << "</text>\n";
    const double step = last * i / kGridLines;
    out << "<text x='" << x(step) << "' y='" << kHeight - kBottom + 16 << "' text-anchor='middle'>"
        << static_cast<long>(step) << "</text>\n";
  }
  out << "<text x='" << x(last / 2) << "' y='" << kHeight - 6 << "' text-anchor='middle'>step</text>\n";
  for (std::size_t i = 0; i < kLines.size(); ++i) {
    out << "<polyline fill='none' stroke='" << kLines[i].colour << "' stroke-width='1.5' points='";
    for (const CurvePoint& point : curve) {
      out << x(static_cast<double>(point.step)) << ',' << y(kLines[i].value(point)) << ' ';
    }
    out << "'/><text x='" << kWidth - kRight + 12 << "' y='" << kTop + 14 + 18 * static_cast<double>(i)
        << "' fill='" << kLines[i].colour << "'>" << kLines[i].name << "</text>\n";
  }
  out << "</svg>\n";
}

}  // namespace s4tp::train
