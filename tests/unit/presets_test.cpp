#include "algo/sadrf/presets.hpp"

#include <gtest/gtest.h>

#include "algo/sadrf/field.hpp"

namespace s4tp::sadrf {

// CORE-071: the default parameters are the paper's preset with the look-ahead that shrinks, but for the
// threshold.
TEST(Presets, DefaultIsThePaperShrinking) {
  Parameters chosen;
  chosen.risk.widening = 0.1F;
  chosen.risk.look_ahead_shrinks = 0.0F;
  choose_risk(FieldPreset::kPaper, LookAhead::kShrinking, chosen);
  chosen.risk.threshold = Parameters{}.risk.threshold;
  EXPECT_EQ(parameters_crc(chosen), parameters_crc(Parameters{}));
}

// CORE-071: kolekar2020 with the fixed look-ahead: m = 0.001, k1 = 0, k2 = 1.3823 (method.md 3); costs
// and the social weight stay as they were. All four pairs are valid, each with a threshold of its own.
TEST(Presets, EveryPairIsValid) {
  Parameters chosen;
  chosen.risk.weight_social = 0.25F;
  choose_risk(FieldPreset::kKolekar2020, LookAhead::kFixed, chosen);
  const FieldParams field = field_params(chosen, 2.0F);
  EXPECT_FLOAT_EQ(field.widening, 0.001F);
  EXPECT_FLOAT_EQ(field.widening_inner, 0.0F);
  EXPECT_FLOAT_EQ(field.widening_outer, 1.3823F);
  EXPECT_FLOAT_EQ(field.base_width_m, 0.5F);
  EXPECT_EQ(chosen.risk.look_ahead_shrinks, 0.0F);
  EXPECT_FLOAT_EQ(chosen.risk.weight_social, 0.25F);
  for (const FieldPreset preset : {FieldPreset::kPaper, FieldPreset::kKolekar2020}) {
    float shrinking = 0.0F;
    for (const LookAhead look_ahead : {LookAhead::kShrinking, LookAhead::kFixed}) {
      choose_risk(preset, look_ahead, chosen);
      int first_bad = 0;
      EXPECT_EQ(validate(chosen, first_bad), Status::kOk);
      if (look_ahead == LookAhead::kShrinking) shrinking = chosen.risk.threshold;
    }
    EXPECT_GT(chosen.risk.threshold, shrinking);  // who looks further sees more
  }
}

}  // namespace s4tp::sadrf
