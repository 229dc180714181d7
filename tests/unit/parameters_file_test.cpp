// Parameters from a TOML file: what is taken, and what a user is told when it is not.

#include "sim_host/campaign/parameters_file.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <string>

#include "algo/sadrf/presets.hpp"

namespace s4tp::campaign {
namespace {

/// Loads `text` as a file; the message of the refusal goes to `error`.
Parameters load(const std::string& text, std::string* error = nullptr) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("s4tp_parameters_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  const std::filesystem::path file = folder / "s4tp_parameters_file_test.toml";
  std::ofstream(file) << text;
  Parameters parameters;
  try {
    parameters = load_parameters(file);
  } catch (const std::runtime_error& refused) {
    if (error != nullptr) *error = refused.what();
  }
  std::filesystem::remove_all(folder);
  return parameters;
}

// Named fields are taken, integers too; the others keep their defaults.
TEST(ParametersFile, TakesNamedFields) {
  const Parameters parameters = load("[comfort]\nheadway_s = 2\n[risk]\nweight_social = 0.25\n");
  EXPECT_EQ(parameters.comfort.headway_s, 2.0F);
  EXPECT_EQ(parameters.risk.weight_social, 0.25F);
  EXPECT_EQ(parameters.vehicle.wheelbase_m, Parameters{}.vehicle.wheelbase_m);
}

// A preset and a look-ahead by name set their numbers and the threshold; a number in the file comes after
// them.
TEST(ParametersFile, PresetsByName) {
  const Parameters parameters =
      load("[risk]\nwidening = 0.02\npreset = \"kolekar2020\"\nlook_ahead = \"fixed\"\n");
  Parameters expected;
  sadrf::choose_risk(sadrf::FieldPreset::kKolekar2020, sadrf::LookAhead::kFixed, expected);
  expected.risk.widening = 0.02F;
  EXPECT_EQ(parameters_crc(parameters), parameters_crc(expected));
}

// Each kind of mistake is answered with the file, the field and what is accepted.
TEST(ParametersFile, NamesTheMistake) {
  const struct {
    const char* text;
    const char* told;
  } cases[] = {
      {"[comfort]\nhedway_s = 2.0\n", "no parameter 'comfort.hedway_s'"},
      {"[comfort]\nheadway_s = \"two\"\n", "comfort.headway_s is not a number"},
      {"[comfort]\nheadway_s = 99.0\n", "comfort.headway_s = 99.0"},
      {"headway_s = 2.0\n", "'headway_s' is not a group"},
      {"[risk]\npreset = \"newest\"\n", "risk.preset = 'newest'; accepted: paper, kolekar2020"},
      {"[risk]\nlook_ahead = 3\n", "risk.look_ahead is not a name; accepted: shrinking, fixed"},
      {"[comfort\n", "s4tp_parameters_file_test.toml"},
  };
  for (const auto& one : cases) {
    std::string error;
    (void)load(one.text, &error);
    EXPECT_NE(error.find(one.told), std::string::npos) << one.text << " gave: " << error;
    EXPECT_NE(error.find("s4tp_parameters_file_test.toml"), std::string::npos) << error;
  }
}

}  // namespace
}  // namespace s4tp::campaign
