#pragma once
/// The predictor of a build: the network where valid weights are at hand, the kinematic one where not.
/// The watched vehicles are the network's; all others, and whom it is not trusted about, are the kinematic
/// predictor's.

#include "algo/satp/decoder.hpp"
#include "algo/satp/encoder.hpp"
#include "algo/satp/prediction_trust.hpp"
#include "algo/satp/predictor.hpp"
#include "algo/satp/weight_image.hpp"

namespace s4tp::satp {

class SatpPredictor {
 public:
  /// Reads the scene once; everything given must outlive the following calls of this cycle.
  /// \param weights  not present: all is as Predictor says \param trust  null: the network is trusted
  /// \param scratch  used during the call only
  void encode(const satp::Weights& weights, const scene::Scene& scene, const Parameters& parameters,
              std::uint32_t start_ms, const YieldBeliefs* beliefs, const PredictionTrust* trust,
              satp::EncoderScratch& scratch);

  void hypotheses(YieldHypotheses (&result)[kMaxAgents]) const { kinematic_.hypotheses(result); }

  /// As Predictor::decode. SATP-052 Without weights the bits are Predictor's. SATP-053 What
  /// was seen of a vehicle weighs its futures by how likely each is to let us pass, or, of one that stands, to
  /// go on standing; there is always one in which it does. SATP-054 What trust is missing goes to the kinematic future; without any,
  /// its futures stand alone.
  void decode(const Trajectory* plan, int allowance, PredictionSet& prediction) const;

  /// Room for one prediction until the next encode(): who may be chosen need not be predicted again.
  void put_aside(const PredictionSet& prediction) { room_.decoded.aside = prediction; }
  /// The last one put aside.
  [[nodiscard]] const PredictionSet& aside() const { return room_.decoded.aside; }

  void constant_velocity(KinematicSet& prediction) const { kinematic_.constant_velocity(prediction); }

  [[nodiscard]] int work() const { return work_ + kinematic_.work(); }
  /// Whether the network speaks.
  [[nodiscard]] bool learned() const { return weights_.present(); }

 private:
  void decode_one(const satp::PlanInput* plan, int index, AgentPrediction& result) const;
  void blend(const EgoMotion& ego, int index, float trust, AgentPrediction& kinematic,
             AgentPrediction& result) const;
  void believe(int index, const satp::Futures& futures, AgentPrediction& result) const;

  Predictor kinematic_;
  satp::Weights weights_;
  const scene::Scene* scene_ = nullptr;
  const Parameters* parameters_ = nullptr;
  const YieldBeliefs* beliefs_ = nullptr;
  const PredictionTrust* trust_ = nullptr;
  float lead_s_ = 0.0F;
  mutable int work_ = 0;
  satp::Encoded encoded_;

  struct Decoding {
    satp::PlanInput plan;
    satp::Futures futures;
    satp::DecoderScratch scratch;
    AgentPrediction result;
    AgentPrediction kinematic;
  };
  struct Decoded {
    Decoding decoding;
    PredictionSet aside;
  };
  /// What is read is needed until it is encoded, the rest from then on.
  union Room {
    Room() : input() {}
    satp::NetworkInput input;
    Decoded decoded;
  };
  mutable Room room_;
};

}  // namespace s4tp::satp
