#include "sim_host/view/haze.hpp"

#include <algorithm>
#include <cmath>

namespace s4tp::view {
namespace {

constexpr double kFullRisk = 12.0;     // painted deepest
constexpr double kFaintest = 0.08;     // below it nothing is painted
constexpr float kMaxCurvature = 0.2F;  // 1/m

sadrf::Field field_of(const traffic::CarState& car, map::Vec2 origin) {
  const auto length_m = static_cast<float>(car.length_m);
  const auto speed_mps = static_cast<float>(car.speed_mps);
  const float wheelbase_m = 0.6F * length_m;
  const float turn = static_cast<float>(car.yaw_rate_radps) / std::max(speed_mps, 1.0F);
  const float curvature = speed_mps > 1.0F ? std::clamp(turn, -kMaxCurvature, kMaxCurvature) : 0.0F;
  const Pose centre{static_cast<float>(car.centre.x - origin.x), static_cast<float>(car.centre.y - origin.y),
                    static_cast<float>(car.heading_rad)};
  const sadrf::DriverState driver{shift_ahead(centre, -0.3F * length_m), speed_mps,
                                  std::atan(wheelbase_m * curvature), wheelbase_m};
  return sadrf::prepare_field(sadrf::paper_preset(static_cast<float>(car.width_m)), driver);
}

}  // namespace

Haze::Haze(const std::vector<traffic::CarState>& cars, map::Vec2 origin) : origin_(origin) {
  for (const traffic::CarState& car : cars) fields_.push_back(field_of(car, origin));
}

double Haze::at(map::Vec2 point) const {
  const Point local{static_cast<float>(point.x - origin_.x), static_cast<float>(point.y - origin_.y)};
  float risk = 0.0F;
  for (const sadrf::Field& field : fields_) {
    if (norm(local - field.origin) < field.look_ahead_m + 1.0F) risk += sadrf::field_at(field, local);
  }
  const double shown = std::min(1.0, std::sqrt(static_cast<double>(risk) / kFullRisk));
  return shown > kFaintest ? shown : 0.0;
}

std::string Haze::grid(map::Vec2 low, map::Vec2 high, double cell_m) const {
  const auto columns = static_cast<int>(std::ceil((high.x - low.x) / cell_m));
  const auto rows = static_cast<int>(std::ceil((high.y - low.y) / cell_m));
  std::string letters;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const double depth = at({low.x + (column + 0.5) * cell_m, low.y + (row + 0.5) * cell_m});
      letters += static_cast<char>('a' + std::lround(kDeepest * depth));
    }
  }
  return in_runs(letters);
}

std::string in_runs(const std::string& letters) {
  if (letters.find_first_not_of('a') == std::string::npos) return {};
  std::string text;
  for (std::size_t i = 0; i < letters.size();) {
    const std::size_t end = std::min(letters.find_first_not_of(letters[i], i), letters.size());
    if (end - i > 1) text += std::to_string(end - i);
    text += letters[i];
    i = end;
  }
  return text;
}

}  // namespace s4tp::view
