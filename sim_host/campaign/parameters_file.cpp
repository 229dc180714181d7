#include "sim_host/campaign/parameters_file.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <string>
#include <toml.hpp>
#include <vector>

#include "algo/core/parameter_info.hpp"
#include "algo/sadrf/presets.hpp"
#include "sim_host/world/scenario/toml_table.hpp"
#include "sim_host/world/scenario/utf8.hpp"

namespace s4tp::campaign {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& what) {
  throw std::runtime_error(file.string() + ": " + what);
}

std::string range_of(const ParameterInfo& info) {
  std::ostringstream text;
  text << info.minimum << " .. " << info.maximum << ' ' << info.unit;
  return text.str();
}

/// [risk] preset and look_ahead choose several numbers at once; numbers the file names override them.
void choose_preset(const std::filesystem::path& file, const toml::table& fields, Parameters& parameters) {
  const auto index_of = [&](const std::string& field, const std::vector<std::string>& names) {
    const auto found = fields.find(field);
    if (found == fields.end()) return 0;
    const std::string accepted = names[0] + ", " + names[1];
    if (!found->second.is_string()) refuse(file, "risk." + field + " is not a name; accepted: " + accepted);
    const std::string name = found->second.as_string();
    const auto place = std::find(names.begin(), names.end(), name);
    if (place == names.end()) refuse(file, "risk." + field + " = '" + name + "'; accepted: " + accepted);
    return static_cast<int>(place - names.begin());
  };
  const int preset = index_of("preset", {"paper", "kolekar2020"});
  const int look_ahead = index_of("look_ahead", {"shrinking", "fixed"});
  sadrf::choose_risk(static_cast<sadrf::FieldPreset>(preset), static_cast<sadrf::LookAhead>(look_ahead),
                     parameters);
}

bool names_preset(const std::string& group, const std::string& field) {
  return group == "risk" && (field == "preset" || field == "look_ahead");
}

}  // namespace

Parameters load_parameters(const std::filesystem::path& file) {
  scenario::require_utf8(file);
  Parameters parameters;
  const toml::value root = scenario::parse_toml(file);
  for (const auto& [group, fields] : root.as_table()) {
    if (!fields.is_table()) refuse(file, "'" + group + "' is not a group; accepted: [group] field = value");
    if (group == "risk") choose_preset(file, fields.as_table(), parameters);
    for (const auto& [field, value] : fields.as_table()) {
      if (names_preset(group, field)) continue;
      const std::string name = group + "." + field;
      const int index = find_parameter(name.c_str());
      if (index < 0) refuse(file, "no parameter '" + name + "'; docs/parameters.md lists them");
      if (!value.is_floating() && !value.is_integer()) {
        refuse(file, name + " is not a number; accepted: " + range_of(parameter_info(index)));
      }
      const double number =
          value.is_integer() ? static_cast<double>(value.as_integer()) : value.as_floating();
      set_parameter(parameters, index, static_cast<float>(number));
    }
  }
  int first_bad = 0;
  if (validate(parameters, first_bad) != Status::kOk) {
    const ParameterInfo& info = parameter_info(first_bad);
    refuse(file, std::string(info.name) + " = " + std::to_string(get_parameter(parameters, first_bad)) +
                     " is out of range; accepted: " + range_of(info));
  }
  return parameters;
}

}  // namespace s4tp::campaign
