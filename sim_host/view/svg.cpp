#include "sim_host/view/svg.hpp"

#include <fstream>
#include <iomanip>
#include <numbers>
#include <stdexcept>

#include "sim_host/view/html.hpp"

namespace s4tp::view {

Svg::Svg(map::Vec2 low, map::Vec2 high, double pixels_per_m, double below_px)
    : low_(low),
      high_(high),
      scale_(pixels_per_m),
      width_px_((high.x - low.x) * pixels_per_m),
      map_height_px_((high.y - low.y) * pixels_per_m),
      height_px_(map_height_px_ + below_px) {
  body_ << std::fixed << std::setprecision(1);
}

map::Vec2 Svg::to_px(map::Vec2 point) const {
  return {(point.x - low_.x) * scale_, (high_.y - point.y) * scale_};
}

void Svg::line(const std::vector<map::Vec2>& points, const Stroke& stroke) {
  body_
      << "<polyline clip-path='url(#map)' fill='none' stroke-linecap='butt' stroke-linejoin='round' stroke='"
      << stroke.colour << "' stroke-width='" << stroke.width_m * scale_ << "' stroke-opacity='"
      << std::setprecision(2) << stroke.opacity << std::setprecision(1) << "'"
      << (stroke.dashed ? " stroke-dasharray='6 6'" : "") << " points='";
  for (const map::Vec2& point : points) {
    const map::Vec2 px = to_px(point);
    body_ << px.x << ',' << px.y << ' ';
  }
  body_ << "'/>\n";
}

void Svg::box(map::Vec2 centre, double heading_rad, double length_m, double width_m, const std::string& fill,
              double opacity) {
  const map::Vec2 px = to_px(centre);
  const double length = length_m * scale_;
  const double width = width_m * scale_;
  body_ << "<g clip-path='url(#map)'><rect x='" << -length / 2 << "' y='" << -width / 2 << "' width='"
        << length << "' height='" << width << "' rx='" << width / 5 << "' fill='" << fill
        << "' fill-opacity='" << std::setprecision(2) << opacity << std::setprecision(1)
        << "' transform='translate(" << px.x << ' ' << px.y << ") rotate("
        << -heading_rad * 180.0 / std::numbers::pi << ")'/></g>\n";
}

void Svg::cell(map::Vec2 low, double size_m, const std::string& fill, double opacity) {
  const map::Vec2 px = to_px({low.x, low.y + size_m});
  body_ << "<rect x='" << px.x << "' y='" << px.y << "' width='" << size_m * scale_ << "' height='"
        << size_m * scale_ << "' fill='" << fill << "' fill-opacity='" << std::setprecision(2) << opacity
        << std::setprecision(1) << "'/>\n";
}

void Svg::text(map::Vec2 at, const std::string& text, double size_px, const std::string& colour) {
  const map::Vec2 px = to_px(at);
  text_px(px.x, px.y, text, size_px, colour);
}

void Svg::text_px(double x, double y, const std::string& text, double size_px, const std::string& colour) {
  body_ << "<text x='" << x << "' y='" << y << "' font-size='" << size_px
        << "' font-family='sans-serif' fill='" << colour << "'>" << escaped(text) << "</text>\n";
}

void Svg::rectangle_px(double x, double y, double width, double height, const std::string& fill) {
  body_ << "<rect x='" << x << "' y='" << y << "' width='" << width << "' height='" << height << "' fill='"
        << fill << "'/>\n";
}

void Svg::path_px(const std::string& data, const std::string& colour, double width) {
  body_ << "<path fill='none' stroke='" << colour << "' stroke-width='" << std::setprecision(2) << width
        << std::setprecision(1) << "' d='" << data << "'/>\n";
}

void Svg::line_px(const std::vector<map::Vec2>& points, const std::string& colour, double width) {
  body_ << "<polyline fill='none' stroke='" << colour << "' stroke-width='" << width << "' points='";
  for (const map::Vec2& point : points) body_ << point.x << ',' << point.y << ' ';
  body_ << "'/>\n";
}

void Svg::save(const std::filesystem::path& file) const {
  std::ofstream stream(file);
  stream << std::fixed << std::setprecision(0) << "<svg xmlns='http://www.w3.org/2000/svg' width='"
         << width_px_ << "' height='" << height_px_ << "' viewBox='0 0 " << width_px_ << ' ' << height_px_
         << "'>\n<clipPath id='map'><rect width='" << width_px_ << "' height='" << map_height_px_
         << "'/></clipPath>\n<rect width='" << width_px_ << "' height='" << height_px_
         << "' fill='#f7f7f4'/>\n"
         << body_.str() << "</svg>\n";
  if (!stream) throw std::runtime_error(file.string() + ": cannot write the picture");
}

}  // namespace s4tp::view
