#include "algo/behavior/required_change.hpp"

#include "algo/core/inline.hpp"
#include "algo/core/standing.hpp"

namespace s4tp::behavior {
namespace {

using Situation = RequiredChangeSituation;

bool needed(const Situation& s) {
  return s.needed;
}
bool over(const Situation& s) {
  return !s.needed;
}
bool waits(const Situation& s) {
  return s.stands && s.at_place;
}
bool sets_off(const Situation& s) {
  return !s.stands;
}

}  // namespace

const Transition<RequiredChange, Situation> kRequiredChangeTable[kRequiredChangeRows] = {
    {RequiredChange::kNone, needed, RequiredChange::kApproaching},
    {RequiredChange::kApproaching, over, RequiredChange::kNone},
    {RequiredChange::kApproaching, waits, RequiredChange::kWaiting},
    {RequiredChange::kWaiting, over, RequiredChange::kNone},
    {RequiredChange::kWaiting, sets_off, RequiredChange::kApproaching},
};

RequiredChangeSituation required_change_situation(const scene::Scene& scene, const Parameters& parameters) {
  const scene::EgoPath& own = scene.ego_paths[0];
  const auto& vehicle = parameters.vehicle;
  const float front_s_m = own.frenet.s_m + vehicle.length_m - vehicle.rear_overhang_m;
  RequiredChangeSituation situation;
  situation.needed = own.changes_needed != 0;
  situation.stands = scene.ego.speed_mps < kStandingMps;
  float way_m = parameters.comfort.standstill_gap_m;
  for (const float by_s_m : own.change_by_s_m) {
    way_m = way_m + scene::kChangeWayM;
    situation.at_place = situation.at_place || by_s_m - front_s_m <= way_m;
  }
  return situation;
}

}  // namespace s4tp::behavior
