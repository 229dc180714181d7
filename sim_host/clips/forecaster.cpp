#include "sim_host/clips/forecaster.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "algo/satp/shipped_weights.hpp"
#include "sim_host/world/scenario/listed.hpp"
#include "sim_host/world/traffic/box.hpp"

namespace s4tp::clips {
namespace {

constexpr double kStep_s = static_cast<double>(kStepS);
constexpr double kPast_s = kPastSteps * kStep_s;
constexpr double kAlong_rad = 1.0;  // a lane whose direction differs by more is not driven along

/// Keeps acceleration and turn rate.
class Steady final : public Forecaster {
 public:
  Steady(bool accelerates, bool turns) : accelerates_(accelerates), turns_(turns) {}

  std::vector<ClipFuture> forecast(const Clip& clip, std::size_t vehicle, int step) const override {
    const auto& states = clip.vehicles[vehicle].states;
    const ClipState& now = states.at(step);
    const ClipState& then = states.at(step - kPastSteps);
    const double a = accelerates_ ? (now.speed_mps - then.speed_mps) / kPast_s : 0.0;
    const double turn = turns_ ? map::wrap_angle(now.heading_rad - then.heading_rad) / kPast_s : 0.0;
    ClipFuture future;
    map::Vec2 place = now.centre;
    double speed = now.speed_mps;
    double heading = now.heading_rad;
    for (map::Vec2& at : future.places) {
      const double next = std::max(0.0, speed + a * kStep_s);
      const double way_m = 0.5 * (speed + next) * kStep_s;
      place.x += way_m * std::cos(heading + 0.5 * turn * kStep_s);
      place.y += way_m * std::sin(heading + 0.5 * turn * kStep_s);
      heading += turn * kStep_s;
      speed = next;
      at = place;
    }
    return {future};
  }

 private:
  bool accelerates_;
  bool turns_;
};

/// Along the lane.
class AlongLane final : public Forecaster {
 public:
  std::vector<ClipFuture> forecast(const Clip& clip, std::size_t vehicle, int step) const override {
    const ClipState& now = clip.vehicles[vehicle].states.at(step);
    int lane = -1;
    double offset_m = std::numeric_limits<double>::infinity();
    double s = 0.0;
    for (std::size_t i = 0; i < clip.lanes.size(); ++i) {
      const map::Polyline& centre = clip.lanes[i].centre;
      const map::PolylineProjection at = centre.project(now.centre);
      const double turned = map::wrap_angle(centre.at(at.s_m).heading_rad - now.heading_rad);
      const bool on_it = at.s_m >= 0.0 && at.s_m <= centre.length_m() &&
                         std::abs(at.d_m) <= 0.5 * clip.lanes[i].width_m && std::abs(turned) < kAlong_rad;
      if (!on_it || std::abs(at.d_m) >= std::abs(offset_m)) continue;
      lane = static_cast<int>(i);
      offset_m = at.d_m;
      s = at.s_m;
    }
    if (lane < 0) return Steady(false, false).forecast(clip, vehicle, step);
    ClipFuture future;
    for (map::Vec2& place : future.places) {
      s += now.speed_mps * kStep_s;
      for (int next = straightest(clip, lane); s > length_m(clip, lane) && next >= 0;
           next = straightest(clip, lane)) {
        s -= length_m(clip, lane);
        lane = next;
      }
      const map::PolylinePose at = clip.lanes[static_cast<std::size_t>(lane)].centre.at(s);
      place = {at.point.x - offset_m * std::sin(at.heading_rad),
               at.point.y + offset_m * std::cos(at.heading_rad)};
    }
    return {future};
  }

 private:
  static double length_m(const Clip& clip, int lane) {
    return clip.lanes[static_cast<std::size_t>(lane)].centre.length_m();
  }
  static int straightest(const Clip& clip, int lane) {
    const map::Polyline& here = clip.lanes[static_cast<std::size_t>(lane)].centre;
    const double end_rad = here.at(here.length_m()).heading_rad;
    int best = -1;
    double least_rad = std::numeric_limits<double>::infinity();
    for (const int next : clip.lanes[static_cast<std::size_t>(lane)].successors) {
      const map::Polyline& there = clip.lanes[static_cast<std::size_t>(next)].centre;
      const double turn_rad = std::abs(map::wrap_angle(there.at(there.length_m()).heading_rad - end_rad));
      if (turn_rad >= least_rad) continue;
      least_rad = turn_rad;
      best = next;
    }
    return best;
  }
};

}  // namespace

const std::vector<std::string>& forecaster_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all{"kinematic", "constant_velocity", "constant_acceleration",
                                 "constant_turn_rate", "lane_following"};
    if (satp::shipped_weights().image != nullptr) all.insert(all.begin(), "satp");
    return all;
  }();
  return names;
}

std::unique_ptr<Forecaster> make_forecaster(const std::string& name) {
  if (name == "satp") return make_satp_forecaster();
  if (name == "kinematic") return make_kinematic_forecaster();
  if (name == "constant_velocity") return std::make_unique<Steady>(false, false);
  if (name == "constant_acceleration") return std::make_unique<Steady>(true, false);
  if (name == "constant_turn_rate") return std::make_unique<Steady>(false, true);
  if (name == "lane_following") return std::make_unique<AlongLane>();
  throw std::invalid_argument("no predictor '" + name +
                              "'; there are: " + scenario::listed(forecaster_names()));
}

}  // namespace s4tp::clips
