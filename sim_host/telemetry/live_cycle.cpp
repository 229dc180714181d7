#include "sim_host/telemetry/live_cycle.hpp"

#include <algorithm>
#include <cmath>

#include "algo/planner/planner.hpp"
#include "algo/trajectory/bicycle.hpp"
#include "sim_host/telemetry/watch.hpp"
#include "sim_host/telemetry/who_matters.hpp"
#include "sim_host/view/haze.hpp"
#include "sim_host/view/html.hpp"
#include "sim_host/view/plan_numbers.hpp"
#include "sim_host/view/plan_words.hpp"

namespace s4tp::telemetry {
namespace {

using nlohmann::ordered_json;

constexpr int kStepsShown = 2;  // every so many of a horizon
constexpr std::uint8_t kNobody = 255;

double rounded(float value) {
  return std::isfinite(value) ? std::round(100.0 * static_cast<double>(value)) / 100.0 : 0.0;
}

void add(std::vector<double>& line, Point point) {
  line.push_back(rounded(point.x_m));
  line.push_back(rounded(point.y_m));
}

std::vector<double> line_of(const Trajectory& trajectory) {
  std::vector<double> line;
  for (int i = 0; i < kTrajectoryPoints; i += kStepsShown)
    add(line, position(trajectory.points[i].rear_axle));
  return line;
}

ordered_json box_json(const Pose& centre, float speed_mps, float length_m, float width_m) {
  return {{"x", rounded(centre.x_m)},
          {"y", rounded(centre.y_m)},
          {"heading", std::round(1000.0 * static_cast<double>(centre.heading_rad)) / 1000.0},
          {"speed", rounded(speed_mps)},
          {"length", rounded(length_m)},
          {"width", rounded(width_m)}};
}

ordered_json road_json(const CycleRecord& cycle) {
  ordered_json lanes = ordered_json::array();
  for (const Lane& lane : cycle.map.lanes) {
    if (!cycle.has_map || !lane.present) continue;
    std::vector<double> line;
    for (int i = 0; i < std::min<int>(lane.point_count, kMaxLanePoints); ++i) add(line, lane.points[i]);
    lanes.push_back({{"width", rounded(lane.width_m)}, {"junction", lane.in_junction}, {"line", line}});
  }
  return lanes;
}

std::vector<double> terms(const planner::CostBreakdown& cost) {  // in tenths, as a replay has them
  std::vector<double> values;
  for (const float term : {cost.progress, cost.speed, cost.jerk, cost.lateral, cost.lane, cost.risk})
    values.push_back(std::isfinite(term) ? std::round(10.0 * static_cast<double>(term)) : 0.0);
  return values;
}

std::vector<long> peaks(const float (&series)[kHorizonSteps]) {
  std::vector<long> values;
  for (int i = 0; i < kHorizonSteps; i += kStepsShown)
    values.push_back(std::lround(*std::max_element(series + i, series + i + kStepsShown)));
  return values;
}

ordered_json candidates_json(const ecu::PlanRecord& plan, const CycleRecord& cycle,
                             const Parameters& parameters) {
  static constexpr const char* kWhy[] = {"", "beyond the car's limits", "", "refused by the guard",
                                         "left out"};
  const std::vector<RolledOut> candidates = candidates_of(plan, cycle, parameters);
  const auto [least, most] = cost_range(candidates);
  ordered_json list = ordered_json::array();
  for (const RolledOut& one : candidates) {
    const double part = most > least ? rounded((one.cost.total() - least) / (most - least)) : 0.0;
    list.push_back({{"part", one.costed ? ordered_json(part) : ordered_json()},
                    {"cost", one.costed ? ordered_json(rounded(one.cost.total())) : ordered_json()},
                    {"why", kWhy[static_cast<int>(one.rejection)]},
                    {"chosen", one.chosen},
                    {"line", line_of(one.trajectory)}});
  }
  return list;
}

ordered_json stages_json(const ecu::PlanRecord& plan, const CycleRecord& cycle) {
  static constexpr const char* kNames[planner::kStageCount] = {
      "scene", "candidates", "predict", "rank", "exact risk", "optimize", "check", "explain"};
  const planner::WorkAllowance allowed;
  const int most[planner::kStageCount] = {kMaxTracks,
                                          allowed.candidates,
                                          allowed.prediction * (1 + allowed.decisions),
                                          allowed.candidates,
                                          allowed.exact_risks,
                                          allowed.optimizer_iterations,
                                          0,
                                          0};
  ordered_json list = ordered_json::array();
  for (int i = 0; i < planner::kStageCount; ++i) {
    list.push_back({{"name", kNames[i]},
                    {"us", std::lround(0.001 * cycle.stage_ns[i])},
                    {"work", plan.explanation.work[i]},
                    {"most", most[i]}});
  }
  return list;
}

ordered_json risk_json(const sadrf::HeatMap& map, const CycleRecord& cycle) {
  std::string letters;
  for (const auto& row : map.cells) {
    for (const std::uint8_t level : row) {
      const int depth = level <= sadrf::kHeatHighest ? level * view::kDeepest / sadrf::kHeatHighest : 0;
      letters += static_cast<char>('a' + depth);
    }
  }
  const Pose& us = cycle.scene.ego.rear_axle;
  const Point corner = offset_point(us, -static_cast<float>(sadrf::kHeatBehind), -0.5F * sadrf::kHeatRows);
  return {{"x", rounded(corner.x_m)},
          {"y", rounded(corner.y_m)},
          {"heading", us.heading_rad},
          {"columns", sadrf::kHeatColumns},
          {"cell", 1},
          {"grid", view::in_runs(letters)}};
}

ordered_json vehicles_json(const ecu::PlanRecord& plan, const CycleRecord& cycle,
                           const campaign::CycleTrace& trace, const Parameters& parameters,
                           const std::vector<GroundClaim>& claims) {
  const std::vector<float> shares = risk_shares(plan, cycle, parameters);
  ordered_json list = ordered_json::array();
  for (int i = 0; i < cycle.scene.agents.size(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    const Track& track = cycle.scene.agents[i].track;
    ordered_json one = box_json(track.centre, track.speed_mps, track.length_m, track.width_m);
    const long belief = gives_way(cycle, i, claims[at]);
    one.update({{"id", track.id},
                {"name", view::vehicle_name(trace, track.id)},
                {"gives_way", belief < 0 ? ordered_json() : ordered_json(belief)},
                {"claim", claim_words(claims[at])},
                {"risk", percent(shares[at])}});
    list.push_back(one);
  }
  return list;
}

ordered_json futures_json(const CycleRecord& cycle) {
  ordered_json list = ordered_json::array();
  for (const satp::AgentPrediction& agent : cycle.prediction.agents) {
    if (agent.agent >= cycle.scene.agents.size()) continue;
    for (const satp::Mode& mode : agent.modes) {
      std::vector<double> line;
      for (int i = kStepsShown - 1; i < kHorizonSteps; i += kStepsShown) add(line, position(mode.steps[i]));
      list.push_back({{"car", cycle.scene.agents[agent.agent].track.id},
                      {"percent", percent(mode.probability)},
                      {"yields", mode.yields_percent >= 50},
                      {"line", line}});
    }
  }
  return list;
}

}  // namespace

ordered_json ecu_json(const IdentityRecord& identity, const ecu::ControlRecord& control,
                      const StatusRecord& status) {
  static constexpr const char* kStates[] = {"error-active", "error-passive", "bus off", "down"};
  ordered_json faults = ordered_json::array();
  for (int bit = 0; bit < ecu::kFaultCount; ++bit) {
    if ((control.faults >> bit & 1U) != 0) faults.push_back(ecu::fault_name(bit));
  }
  return {{"planner", identity.planner},
          {"bus", identity.bus},
          {"mode", ecu::mode_name(control.mode)},
          {"faults", faults},
          {"gate", control.violations},
          {"asked_mps2", rounded(control.asked.acceleration_mps2)},
          {"steering_rad", rounded(control.sent.steering_rad)},
          {"cycles", status.cycles.count},
          {"late", status.cycles.slips},
          {"accepted", status.accepted_frames},
          {"rejected", status.rejected_frames},
          {"sent", status.bus.sent},
          {"received", status.bus.received},
          {"dropped", status.bus.dropped},
          {"errors", status.bus.errors},
          {"state", kStates[static_cast<int>(status.bus_state)]}};
}

ordered_json cycle_json(const ecu::PlanRecord& plan, const CycleRecord& cycle, const campaign::EcuState& ecu,
                        const Parameters& parameters, const sadrf::HeatMap* risk) {
  const campaign::CycleTrace trace = trace_of(plan, &cycle, ecu);
  const planner::Explanation& e = plan.explanation;
  const std::vector<GroundClaim> claims = claims_of(plan, cycle, parameters);
  const WhoMatters who = who_matters(trace, cycle, claims);
  const EgoState& us = cycle.scene.ego;
  ordered_json json{
      {"t", plan.plan.start_ms},
      {"ego", box_json(shift_ahead(us.rear_axle, trajectory::rear_axle_to_centre_m(parameters)), us.speed_mps,
                       parameters.vehicle.length_m, parameters.vehicle.width_m)},
      {"acceleration", rounded(us.acceleration_mps2)},
      {"steering", rounded(us.steering_rad)},
      {"road", road_json(cycle)},
      {"vehicles", vehicles_json(plan, cycle, trace, parameters, claims)},
      {"futures", futures_json(cycle)},
      {"plan", plan.plan.kind == PlanKind::kNone ? std::vector<double>{} : line_of(plan.plan.trajectory)},
      {"fail_safe", plan.plan.kind == PlanKind::kDrive ? line_of(fail_safe_of(plan, parameters).trajectory)
                                                       : std::vector<double>{}},
      {"candidates", candidates_json(plan, cycle, parameters)},
      {"words", view::in_words(trace)},
      {"numbers", view::in_numbers(trace)},
      {"who",
       {{"id", who.track},
        {"blocks", who.blocks},
        {"name", who.name},
        {"belief", who.belief},
        {"claim", who.claim}}},
      {"riskiest", e.dominating_track == kNobody ? -1 : e.dominating_track},
      {"waited_s", rounded(cycle.scene.waited_s)},
      {"cost", terms(e.chosen_cost)},
      {"runner_up", terms(e.runner_up_cost)},
      {"counts",
       {e.candidate_count, view::rejected(e, trajectory::Rejection::kInfeasible),
        view::rejected(e, trajectory::Rejection::kRefused)}},
      {"risk", {peaks(e.risk.obstacle), peaks(e.risk.road), peaks(e.risk.social)}},
      {"stages", stages_json(plan, cycle)}};
  if (risk != nullptr) json["haze"] = risk_json(*risk, cycle);
  return json;
}

}  // namespace s4tp::telemetry
