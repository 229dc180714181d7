#include "sim_host/world/traffic/social_value.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace s4tp::traffic {
namespace {

constexpr double kCompetitive_rad = -0.2;
constexpr double kProsocial_rad = 0.8;

/// A number at -0.2, 0 and 0.8 rad; straight between them.
struct Column {
  double SocialTraits::*trait;
  double competitive;
  double individual;
  double prosocial;
};

// Headway: with SUMO's 1 s these are the 0.8 to 2 s that drivers keep (Treiber, Kesting 2013, chapter 11).
// Margin: calibrated at 0 to the gaps of SUMO (docs/traffic.md), so that those of left turns lie within 4 to
// 7 s (HCM 2010, chapters 19, 20: 4.1 s from the major, 7.1 to 7.5 s from the minor road), and wear off while
// waiting (patience; Polus et al. 2003). Braking asked of the one behind and threshold: MOBIL's 4 and 0.1
// m/s^2 (Kesting, Treiber, Helbing 2007) and less pushy ones.
constexpr std::array kColumns{
    Column{&SocialTraits::headway, 0.8, 1.0, 1.8},
    Column{&SocialTraits::min_gap, 0.7, 1.0, 1.4},
    Column{&SocialTraits::acceleration, 1.2, 1.0, 0.7},
    Column{&SocialTraits::speed, 1.08, 1.0, 0.95},
    Column{&SocialTraits::gap_margin_s, 0.8, 2.8, 4.0},
    Column{&SocialTraits::patience_s, 15.0, 60.0, 90.0},
    Column{&SocialTraits::change_threshold_mps2, 0.05, 0.1, 0.3},
    Column{&SocialTraits::asked_braking_mps2, 4.0, 3.0, 2.0},
    Column{&SocialTraits::courtesy, 0.0, 0.0, 1.0},
    Column{&SocialTraits::rivalry, 1.0, 0.0, 0.0},
};

}  // namespace

SocialTraits social_traits(double svo_rad) {
  const double svo = std::clamp(svo_rad, kCompetitive_rad, kProsocial_rad);
  SocialTraits traits;
  for (const Column& column : kColumns) {
    const double share = svo < 0.0 ? svo / kCompetitive_rad : svo / kProsocial_rad;
    const double end = svo < 0.0 ? column.competitive : column.prosocial;
    traits.*column.trait = column.individual + share * (end - column.individual);
  }
  traits.politeness = std::tan(svo);  // sin(phi) / cos(phi): the others' gain in units of the own one
  return traits;
}

}  // namespace s4tp::traffic
