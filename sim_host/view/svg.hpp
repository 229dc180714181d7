#pragma once
/// A minimal SVG canvas in metres, y up.

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "sim_host/world/map/polyline.hpp"

namespace s4tp::view {

struct Stroke {
  std::string colour = "#000";
  double width_m = 0.2;
  double opacity = 1.0;
  bool dashed = false;
};

class Svg {
 public:
  /// Shows [low, high] in metres at `pixels_per_m`, and `below_px` more pixels under it for charts.
  Svg(map::Vec2 low, map::Vec2 high, double pixels_per_m, double below_px);

  void line(const std::vector<map::Vec2>& points, const Stroke& stroke);
  void box(map::Vec2 centre, double heading_rad, double length_m, double width_m, const std::string& fill,
           double opacity);
  void cell(map::Vec2 low, double size_m, const std::string& fill, double opacity);
  void text(map::Vec2 at, const std::string& text, double size_px, const std::string& colour = "#222");
  /// Text and a filled rectangle in pixels from the top left, for legends and charts.
  void text_px(double x, double y, const std::string& text, double size_px,
               const std::string& colour = "#222");
  void rectangle_px(double x, double y, double width, double height, const std::string& fill);
  /// Strokes path data as SVG writes it, in pixels.
  void path_px(const std::string& data, const std::string& colour, double width);
  void line_px(const std::vector<map::Vec2>& points, const std::string& colour, double width);

  [[nodiscard]] double width_px() const { return width_px_; }
  [[nodiscard]] double map_height_px() const { return map_height_px_; }
  /// \throws std::runtime_error naming the file
  void save(const std::filesystem::path& file) const;

 private:
  [[nodiscard]] map::Vec2 to_px(map::Vec2 point) const;
  map::Vec2 low_;
  map::Vec2 high_;
  double scale_;
  double width_px_;
  double map_height_px_;
  double height_px_;
  std::ostringstream body_;
};

}  // namespace s4tp::view
