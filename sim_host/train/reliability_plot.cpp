#include "sim_host/train/reliability_plot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <stdexcept>

namespace s4tp::train {
namespace {

constexpr double kSide = 320.0;  // of the square
constexpr double kLeft = 52.0;
constexpr double kTop = 16.0;
constexpr double kBottom = 44.0;
constexpr double kRight = 210.0;
constexpr double kLargestDot = 7.0;
constexpr std::array<const char*, 4> kColours{"#1f77b4", "#d62728", "#2ca02c", "#9467bd"};

double x_of(double share) {
  return kLeft + kSide * share;
}
double y_of(double share) {
  return kTop + kSide * (1.0 - share);
}

void draw_frame(std::ostream& out) {
  out << "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 " << kLeft + kSide + kRight << ' '
      << kTop + kSide + kBottom
      << "' font-family='sans-serif' font-size='11'>\n<rect width='100%' height='100%' fill='white'/>\n";
  for (int i = 0; i <= 5; ++i) {
    const double share = 0.2 * i;
    out << "<path d='M" << x_of(0.0) << ' ' << y_of(share) << 'H' << x_of(1.0) << 'M' << x_of(share) << ' '
        << y_of(0.0) << 'V' << y_of(1.0) << "' stroke='#ddd'/><text x='" << kLeft - 6.0 << "' y='"
        << y_of(share) + 4.0 << "' text-anchor='end'>" << share << "</text><text x='" << x_of(share)
        << "' y='" << y_of(0.0) + 16.0 << "' text-anchor='middle'>" << share << "</text>\n";
  }
  out << "<path d='M" << x_of(0.0) << ' ' << y_of(0.0) << 'L' << x_of(1.0) << ' ' << y_of(1.0)
      << "' stroke='#888' stroke-dasharray='4 3'/>\n<text x='" << x_of(0.5) << "' y='" << y_of(0.0) + 34.0
      << "' text-anchor='middle'>expected</text>\n<text transform='rotate(-90)' x='" << -y_of(0.5)
      << "' y='14' text-anchor='middle'>happened</text>\n";
}

}  // namespace

void draw_reliability(const std::vector<Reliability>& curves, const std::filesystem::path& file) {
  std::ofstream out(file);
  draw_frame(out);
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const char* const colour = kColours[i % kColours.size()];
    double most = 1.0;
    for (const auto& bin : curves[i].bins) most = std::max(most, bin["count"].get<double>());
    out << "<polyline fill='none' stroke='" << colour << "' points='";
    for (const auto& bin : curves[i].bins)
      out << x_of(bin["expected"].get<double>()) << ',' << y_of(bin["happened"].get<double>()) << ' ';
    out << "'/>\n";
    for (const auto& bin : curves[i].bins) {
      out << "<circle cx='" << x_of(bin["expected"].get<double>()) << "' cy='"
          << y_of(bin["happened"].get<double>()) << "' r='"
          << 1.5 + kLargestDot * std::sqrt(bin["count"].get<double>() / most) << "' fill='" << colour
          << "' fill-opacity='0.5'/>\n";
    }
    out << "<text x='" << kLeft + kSide + 14.0 << "' y='" << kTop + 14.0 + 18.0 * static_cast<double>(i)
        << "' fill='" << colour << "'>" << curves[i].name << "</text>\n";
  }
  out << "</svg>\n";
  if (!out.flush()) throw std::runtime_error(file.string() + " cannot be written");
}

}  // namespace s4tp::train
