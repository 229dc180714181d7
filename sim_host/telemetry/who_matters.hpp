#pragma once
/// Why we wait or go, in words about one vehicle: who it is, what we believe of it, what it may claim.

#include <string>
#include <vector>

#include "sim_host/campaign/trace.hpp"
#include "sim_host/telemetry/derive.hpp"
#include "sim_host/telemetry/records.hpp"

namespace s4tp::telemetry {

/// Who matters most for what we do.
struct WhoMatters {
  int track = -1;       ///< -1: nobody
  bool blocks = false;  ///< it is why we wait, brake or follow; else it is only watched
  std::string name;     ///< "the oncoming car"
  std::string belief;   ///< how likely it lets us go first; empty where that is no question
  std::string claim;    ///< what it may claim, or leaves to us; empty where ways do not meet
};

/// VIEW-010 Of whom a reason names, it; else who may come first where ways meet, else whose risk is largest.
/// \param claims  of claims_of()
[[nodiscard]] WhoMatters who_matters(const campaign::CycleTrace& trace, const CycleRecord& cycle,
                                     const std::vector<GroundClaim>& claims);

/// What a vehicle may claim, behind "it"; empty: nothing.
[[nodiscard]] std::string claim_words(const GroundClaim& claim);

/// How likely a vehicle of the scene brakes for us [percent]; -1 where that is no question.
[[nodiscard]] long gives_way(const CycleRecord& cycle, int agent, const GroundClaim& claim);

/// In whole percent.
[[nodiscard]] long percent(float part);

}  // namespace s4tp::telemetry
