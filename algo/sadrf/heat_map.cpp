#include "algo/sadrf/heat_map.hpp"

#include "algo/core/check.hpp"
#include "algo/core/inline.hpp"
#include "algo/sadrf/box_integral.hpp"
#include "algo/sadrf/cost_map.hpp"
#include "algo/sadrf/field.hpp"
#include "algo/sadrf/futures.hpp"
#include "algo/sadrf/others_motion.hpp"

namespace s4tp::sadrf {
namespace {

constexpr int kStride = 3;            // steps of the horizon from field to field
constexpr float kCellRadiusM = 0.5F;  // a cell is its centre

Point cell_centre(const scene::Scene& scene, int row, int column) {
  constexpr int kRowsRight = kHeatRows / 2;
  return offset_point(scene.ego.rear_axle, static_cast<float>(column - kHeatBehind) + 0.5F,
                      static_cast<float>(row - kRowsRight) + 0.5F);
}

/// Adds one driver's field to the sums of a row.
void add_field(const scene::Scene& scene, const Field& field, float weight, int row,
               float (&sums)[kHeatColumns]) {
  for (int column = 0; column < kHeatColumns; ++column) {
    const Point centre = cell_centre(scene, row, column);
    if (!out_of_reach(field, centre, kCellRadiusM)) sums[column] += weight * field_at(field, centre);
  }
}

/// True when vehicles cover half of the cell or more: 4 x 4 sub-samples.
bool on_vehicle(const CostBoxes& vehicles, const Pose& cell) {
  constexpr float kReachM = 2.0F;
  for (const CostBox& one : vehicles) {
    const float near_m = kReachM + 0.5F * (one.box.length_m + one.box.width_m);
    if (distance(position(one.box.centre), position(cell)) > near_m) continue;
    return obstacle_cost(vehicles, cell, 1.0F) >= 0.5F;
  }
  return false;
}

CostBoxes vehicles_now(const scene::Scene& scene) {
  CostBoxes boxes;
  for (int i = 0; i < scene.agents.size(); ++i) {
    const Track& track = scene.agents[i].track;
    const Box box = {track.centre, track.length_m, track.width_m};
    if (!boxes.push({box, direction(track.centre.heading_rad), 1.0F, i})) break;
  }
  return boxes;
}

}  // namespace

void heat_row(const scene::Scene& scene, const DrivableArea& area, const satp::PredictionSet& prediction,
              const satp::KinematicSet& others, const Parameters& parameters, int row, HeatMap& map) {
  S4TP_ASSERT(row >= 0 && row < kHeatRows);
  float sums[kHeatColumns] = {};
  const bool shrinks = parameters.risk.look_ahead_shrinks > 0.5F;
  for (const Future& future : all_modes(scene, prediction, others)) {
    const Track& track = scene.agents[future.agent].track;
    FieldParams params = field_params(parameters, track.width_m);
    for (int step = kStride - 1; step < kHorizonSteps; step += kStride) {
      params.look_ahead_s =
          look_ahead_at(parameters.risk.look_ahead_s, shrinks, static_cast<float>(step + 1) * kStepS);
      const Field field =
          field_of_other(params, future.mode->steps[step], motion_at(*future.mode, step), track.length_m);
      const float seconds = static_cast<float>(kStride) * kStepS;
      add_field(scene, field, seconds * future.probability, row, sums);
    }
  }
  const CostBoxes vehicles = vehicles_now(scene);
  for (int column = 0; column < kHeatColumns; ++column) {
    const Point centre = cell_centre(scene, row, column);
    const Pose cell = {centre.x_m, centre.y_m, scene.ego.rear_axle.heading_rad};
    const float part = sqrt(min(sums[column] / kHeatFullScale, 1.0F));
    std::uint8_t level = static_cast<std::uint8_t>(to_int(part * float{kHeatHighest}, 0, kHeatHighest));
    if (level == 0 && area.map != nullptr) {
      const Ground ground = ground_at(area, centre);
      if (ground == Ground::kOffRoad) level = kHeatOffRoad;
      if (ground == Ground::kOpposite) level = kHeatOpposite;
    }
    map.cells[row][column] = on_vehicle(vehicles, cell) ? kHeatVehicle : level;
  }
}

}  // namespace s4tp::sadrf
