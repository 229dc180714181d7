#pragma once
/// Our flows in SUMO's words: what its route files hold.

#include <string>
#include <vector>

#include "sim_host/world/scenario/scenario.hpp"
#include "sim_host/world/traffic/traffic_flow.hpp"

namespace s4tp::sumo {

inline constexpr const char* kEgoName = "ego";  ///< of its vehicle, its type and its route

/// SUMO-004 SUMO separates the names in a list by blanks, and takes every byte outside ASCII for one.
/// \throws std::runtime_error naming file, edge and reason when a name of the scenario does not survive that
void check_names(const scenario::Scenario& scenario);

/// The ego's type and route: a car of our size, with SUMO's ordinary driver.
[[nodiscard]] std::string ego_definitions(const std::vector<std::string>& edges, double length_m,
                                          double width_m, const std::string& driver);

/// SUMO-002 Every departure of the plan as a vehicle of its own type, drawn by us, not by SUMO: the same
/// drivers at the same times as in the built-in traffic. Body, following and speed have SUMO's names; what is
/// social has these:
///
/// \code
///   Driver                   vType            of ours to SUMO's; a driver of orientation 0 has SUMO's default
///   -----------------------  --------------- ---------------------------------------------------------------
///   gap_margin_s             jmTimegapMinor   both are the time between own leaving and the other's arrival:
///                                             as many seconds more or less than 1 s, at least 0
///   patience_s               impatience       SUMO's grows by the same for all (1 in 300 s): by how much
///                                             the driver is ahead of the ordinary one after 10 s of waiting
///   change_threshold_mps2    lcSpeedGain      the share of the ordinary one's gain that is enough, inverted
///   asked_braking_mps2       lcAssertive      gaps asked for shrink as the braking asked for grows
///   rivalry                  lcCooperative    1 - rivalry: makes room, or closes up
///   courtesy, politeness     -                SUMO's default driver makes room always (lcCooperative 1 is the
///                                             most there is), and stops for nobody who has to yield
///   reaction_s               -                SUMO's drivers act in each step
/// \endcode
/// Nobody is made to ignore others (jmIgnore...): no driver of ours does.
[[nodiscard]] std::string flow_definitions(const map::Network& network, const traffic::FlowPlan& plan);

/// A file of both parts.
[[nodiscard]] std::string routes_file(const std::string& definitions);

}  // namespace s4tp::sumo
