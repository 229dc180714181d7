#include "algo/trajectory/swing.hpp"

#include "algo/core/inline.hpp"
#include "algo/trajectory/bicycle.hpp"
#include "algo/trajectory/driven_lines.hpp"
#include "algo/trajectory/elastic_band.hpp"
#include "algo/trajectory/reference_line.hpp"

namespace s4tp::trajectory {
namespace {

constexpr float kReachM = 30.0F;
constexpr float kShortestM = 6.0F;       // a junction to swing in
constexpr float kBackM = 8.0F;           // behind it our rear axle is at its lane's centre again
constexpr float kMostM = 2.5F;           // off its lane: a wide turn, not another way
constexpr float kInLaneM = 0.5F;         // off its centre is still in it
constexpr float kStraightRad = 0.3F;     // who turns by less may swing to either side
constexpr float kSteeringShare = 0.99F;  // some is left to follow with
constexpr float kAim =
    0.93F;  // share of that which is aimed at: what is beyond it decreases ever more slowly
constexpr float kDrawnM = 0.25F;      // further than what is lacking: fewer rounds
constexpr float kUnchangedM = 0.3F;   // the way is the lane's still
constexpr float kAlongCos = 0.7071F;  // 45 degrees
constexpr int kPassesARound = 3;
constexpr int kMostRounds = 20;

// Work (WorkMeter's units).
constexpr int kMostWork = 8'000;  // then there is no way around
constexpr int kLookWork = 10;
constexpr int kMoveWork = 5;  // of a sample, a pass
constexpr int kPlaceWork = 3;
constexpr int kApartWork = 1;
constexpr int kTouchWork = 3;
constexpr int kDeriveWork = 400;

/// One who stands near.
struct Stander {
  Box box;
  Point ahead;
  float reach_m;  ///< of our box and its, from centre to centre
};
using Standers = BoundedVector<Stander, kMaxTracks>;

/// Where the line may be moved.
struct Stretch {
  float enters_s_m = 0.0F;  ///< the junction
  float leaves_s_m = 0.0F;
  int first = 0;  ///< of the samples
  int end = 0;
  int from = 0;  ///< from where on we will be on it
};

int sample_at(const ReferenceLine& line, float s_m) {
  return to_int((s_m - line.start_s_m) / line.spacing_m, 2, kReferenceSamples - 3);
}

/// In the junction ahead or under us. \return false: there is none near enough
bool find_stretch(const scene::Scene& scene, const scene::EgoPath& path, const ReferenceLine& line,
                  const Parameters& parameters, Stretch& stretch) {
  bool any = false;
  for (const scene::PathLane& part : path.path.lanes) {
    const Lane& lane = scene.map->lanes[part.lane];
    if (!lane.in_junction) {
      if (any && stretch.leaves_s_m > path.frenet.s_m) break;
      any = false;
      continue;
    }
    if (!any) stretch.enters_s_m = part.start_s_m;
    any = true;
    stretch.leaves_s_m = part.start_s_m + lane.length_m;
  }
  stretch.first = sample_at(line, stretch.enters_s_m - rear_axle_to_front_m(parameters));
  stretch.end = sample_at(line, stretch.leaves_s_m + kBackM);
  stretch.from = sample_at(line, path.frenet.s_m);
  return any && stretch.enters_s_m < path.frenet.s_m + kReachM && stretch.leaves_s_m > path.frenet.s_m &&
         stretch.leaves_s_m - stretch.enters_s_m > kShortestM && stretch.first < stretch.end;
}

void find_standers(const scene::Scene& scene, const ReferenceLine& line, const Stretch& stretch,
                   const Parameters& parameters, Standers& standers) {
  const Point middle = position(line.samples[(stretch.first + stretch.end) / 2].pose);
  const float half_m = 0.5F * static_cast<float>(stretch.end - stretch.first) * line.spacing_m;
  for (const scene::Agent& agent : scene.agents) {
    if (!is_standing(agent)) continue;
    const Track& track = agent.track;
    const float reach_m = kBystanderGapM + 0.5F * (parameters.vehicle.length_m + parameters.vehicle.width_m +
                                                   track.length_m + track.width_m);
    if (distance(middle, position(track.centre)) > half_m + rear_axle_to_front_m(parameters) + reach_m)
      continue;
    (void)standers.push(
        {{track.centre, track.length_m, track.width_m}, direction(track.centre.heading_rad), reach_m});
  }
}

/// A band that is drawn off those who stand, to one side.
class DrawnBand {
 public:
  DrawnBand(const Standers& standers, const Parameters& parameters, const Stretch& stretch, float side,
            ReferenceLine& line)
      : standers_(standers),
        parameters_(parameters),
        stretch_(stretch),
        side_(side),
        line_(line),
        band_(line, stretch.first, stretch.end) {}

  /// \return whether it leads past all of them, and can be driven
  bool leads_past(int& work) {
    const float limit_1pm =
        kSteeringShare * curvature_for(parameters_.vehicle.steering_max_rad, parameters_.vehicle.wheelbase_m);
    for (int round = 0; round < kMostRounds && work < kMostWork; ++round) {
      bool drivable = false;
      for (int pass = 0; pass < kPassesARound; ++pass) {
        band_.solve();
        drivable = kAim * band_.weigh_bends(kAim * limit_1pm) <= 1.0F;
      }
      work += kPassesARound * kMoveWork * (stretch_.end - stretch_.first);
      if (most_m() > kMostM) return false;
      const bool free = draw_off(work);
      if (drivable && free) return keeps_to_lanes();
    }
    return false;
  }

  void apply() { band_.apply(); }
  [[nodiscard]] float most_m() const {
    float most_m = 0.0F;
    for (int i = stretch_.first; i < stretch_.end; ++i) most_m = max(most_m, norm(band_.moved(i)));
    return most_m;
  }

 private:
  /// Draws every sample where our box lacks room to somebody. \return whether none does
  bool draw_off(int& work) {
    bool free = true;
    for (int i = stretch_.from; i <= stretch_.end; ++i) {
      const Point along = band_.place(i + 1) - band_.place(i - 1);
      const Point ahead = (1.0F / max(norm(along), kRoundingM)) * along;
      const float lacks_m = lack_m(i, ahead, work);
      if (lacks_m <= 0.0F) continue;
      free = false;
      const float by_m = side_ * (lacks_m + kDrawnM);
      if (i >= stretch_.first && i < stretch_.end) band_.hold(i, {-by_m * ahead.y_m, by_m * ahead.x_m});
    }
    return free;
  }

  /// What our box lacks of kBystanderGapM to the nearest. Who leads us where the way is the lane's is no bystander.
  [[nodiscard]] float lack_m(int i, Point ahead, int& work) const {
    const Point centre = band_.place(i) + rear_axle_to_centre_m(parameters_) * ahead;
    const Box ours{{centre.x_m, centre.y_m, 0.0F}, parameters_.vehicle.length_m, parameters_.vehicle.width_m};
    const bool unchanged = norm(band_.moved(i)) < kUnchangedM;
    work += kPlaceWork + kApartWork * standers_.size();
    float lacks_m = 0.0F;
    for (const Stander& other : standers_) {
      if (distance(centre, position(other.box.centre)) > other.reach_m) continue;
      work += kTouchWork;
      if (unchanged && dot(ahead, other.ahead) >= kAlongCos) continue;
      lacks_m = max(lacks_m, kBystanderGapM - separation(ours, ahead, other.box, other.ahead));
    }
    return lacks_m;
  }

  [[nodiscard]] bool keeps_to_lanes() const {
    for (int i = stretch_.first > stretch_.from ? stretch_.first : stretch_.from; i < stretch_.end; ++i) {
      const float s_m = line_.start_s_m + static_cast<float>(i) * line_.spacing_m;
      const bool outside = s_m < stretch_.enters_s_m || s_m > stretch_.leaves_s_m;
      if (outside && norm(band_.moved(i)) > kInLaneM) return false;
    }
    return true;
  }

  static constexpr float kRoundingM = 1e-3F;
  const Standers& standers_;
  const Parameters& parameters_;
  const Stretch& stretch_;
  float side_;
  const ReferenceLine& line_;
  ElasticBand band_;
};

void mark(const Stretch& stretch, float by_m, ReferenceLine& line) {
  const float from_s_m = line.start_s_m + static_cast<float>(stretch.first) * line.spacing_m;
  const float to_s_m = line.start_s_m + static_cast<float>(stretch.end) * line.spacing_m;
  line.swing = {by_m, from_s_m, to_s_m};
  line.tight_from_s_m = line.tight ? min(line.tight_from_s_m, from_s_m) : from_s_m;
  line.tight_to_s_m = line.tight ? max(line.tight_to_s_m, to_s_m) : to_s_m;
  line.tight = true;
}

}  // namespace

int swing_around(const scene::Scene& scene, const scene::EgoPath& path, const Parameters& parameters,
                 ReferenceLine& line) {
  int work = kLookWork;
  Stretch stretch;
  if (!find_stretch(scene, path, line, parameters, stretch)) return work;
  Standers standers;
  find_standers(scene, line, stretch, parameters, standers);
  work += kTouchWork * scene.agents.size();
  const float turn_rad = wrap_angle(reference_at(line, stretch.leaves_s_m).pose.heading_rad -
                                    reference_at(line, stretch.enters_s_m).pose.heading_rad);
  float by_m = 0.0F;
  for (int k = 0; k < 2 && by_m == 0.0F; ++k) {
    const float side = k == 0 ? -1.0F : 1.0F;
    if (side * turn_rad > kStraightRad) continue;
    DrawnBand band(standers, parameters, stretch, side, line);
    if (!band.leads_past(work)) continue;
    by_m = band.most_m();
    band.apply();
  }
  derive(parameters, line);
  if (by_m > 0.0F) mark(stretch, by_m, line);
  return work + kDeriveWork;
}

void widen_zones_swung(float nearest_s_m, scene::EgoPath& path) {
  const scene::Swing& swing = path.driven->swing;
  if (swing.by_m == 0.0F) return;
  for (scene::ConflictZone& zone : path.zones) {
    if (zone.beside || zone.exit_s_m < swing.from_s_m || zone.entry_s_m > swing.to_s_m) continue;
    zone.entry_s_m = min(zone.entry_s_m, max(zone.entry_s_m - swing.by_m, nearest_s_m));
    zone.exit_s_m = zone.exit_s_m + swing.by_m;
  }
}

}  // namespace s4tp::trajectory
