#pragma once
/// From a driver's social value orientation to the numbers it drives by.
///
/// The orientation is an angle phi: the driver weighs own gain by cos(phi), that of others by sin(phi) (Liebrand
/// 1984; Murphy, Ackermann, Handgraaf 2011; in traffic: Schwarting et al. 2019, PNAS 116:24972). 0 is SUMO's
/// default driver, so that a flavour without orientations is SUMO's traffic; below 0 is competitive, pi/4
/// prosocial.

namespace s4tp::traffic {

struct SocialTraits {
  // Factors on what the driver's model says.
  double headway = 1.0;
  double min_gap = 1.0;
  double acceleration = 1.0;
  double speed = 1.0;
  // Values.
  double gap_margin_s = 1.0;  ///< see Driver for these
  double patience_s = 15.0;
  double politeness = 0.0;
  double change_threshold_mps2 = 0.1;
  double asked_braking_mps2 = 3.0;
  double courtesy = 0.0;
  double rivalry = 0.0;
};

/// SOC-001 Monotone in every number: the more social, the longer the gaps and the waiting, the gentler the
/// rest. \param svo_rad  limited to -0.2 .. 0.8
[[nodiscard]] SocialTraits social_traits(double svo_rad);

}  // namespace s4tp::traffic
