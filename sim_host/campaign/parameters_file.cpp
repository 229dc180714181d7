#include "sim_host/campaign/parameters_file.hpp"

#include <sstream>
#include <stdexcept>
#include <string>
#include <toml.hpp>

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

}  // namespace

Parameters load_parameters(const std::filesystem::path& file) {
  Parameters parameters;
  toml::value root;
  try {
    root = toml::parse(file.string());
  } catch (const std::exception& error) {
    refuse(file, error.what());
  }
  for (const auto& [group, fields] : root.as_table()) {
    if (!fields.is_table()) refuse(file, "'" + group + "' is not a group; accepted: [group] field = value");
    for (const auto& [field, value] : fields.as_table()) {
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
