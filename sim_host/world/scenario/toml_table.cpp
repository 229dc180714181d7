#include "sim_host/world/scenario/toml_table.hpp"

#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "sim_host/world/scenario/listed.hpp"
#include "sim_host/world/scenario/toml_shape.hpp"
#include "sim_host/world/scenario/whole_file.hpp"

namespace s4tp::scenario {
namespace {

const toml::value& no_keys() {
  static const toml::value empty = toml::table{};
  return empty;
}

}  // namespace

TomlTable::TomlTable(std::string file, std::string path, const toml::value& value)
    : file_(std::move(file)), path_(std::move(path)), value_(&value) {
  if (!value.is_table()) {
    fail("", "expected a table");
  }
}

void TomlTable::fail(const std::string& key, const std::string& what) const {
  throw std::runtime_error(file_ + ": " + (key.empty() ? path_ : name_of(key)) + ": " + what);
}

std::string TomlTable::name_of(const std::string& key) const {
  return path_.empty() ? key : path_ + "." + key;
}

const toml::value* TomlTable::find(const std::string& key) {
  accepted_.insert(key);
  return value_->contains(key) ? &value_->at(key) : nullptr;
}

const toml::value& TomlTable::require(const std::string& key) {
  const toml::value* found = find(key);
  if (found == nullptr) {
    fail(key, "missing");
  }
  return *found;
}

double TomlTable::number(const std::string& key, double missing, double low, double high) {
  const toml::value* found = find(key);
  return found == nullptr ? missing : number_of(key, *found, low, high);
}

int TomlTable::integer(const std::string& key, int missing, int low, int high) {
  const toml::value* found = find(key);
  if (found == nullptr) {
    return missing;
  }
  if (!found->is_integer() || found->as_integer() < low || found->as_integer() > high) {
    fail(key, "expected an integer from " + std::to_string(low) + " to " + std::to_string(high));
  }
  return static_cast<int>(found->as_integer());
}

bool TomlTable::boolean(const std::string& key, bool missing) {
  const toml::value* found = find(key);
  if (found != nullptr && !found->is_boolean()) {
    fail(key, "expected true or false");
  }
  return found == nullptr ? missing : found->as_boolean();
}

Range TomlTable::range(const std::string& key, double low, double high) {
  const toml::value& found = require(key);
  if (!found.is_array()) {
    const double value = number_of(key, found, low, high);
    return {value, value};
  }
  const toml::array& pair = found.as_array();
  if (pair.size() != 2) {
    fail(key, "expected a number or [low, high]");
  }
  const Range range{number_of(key, pair[0], low, high), number_of(key, pair[1], low, high)};
  if (range.low > range.high) {
    fail(key, "expected low <= high");
  }
  return range;
}

std::string TomlTable::text(const std::string& key) {
  const toml::value& found = require(key);
  if (!found.is_string()) {
    fail(key, "expected a string");
  }
  return found.as_string();
}

std::string TomlTable::text(const std::string& key, const std::string& missing) {
  return find(key) == nullptr ? missing : text(key);
}

std::vector<std::string> TomlTable::texts(const std::string& key) {
  const toml::value& found = require(key);
  std::vector<std::string> all;
  if (!found.is_array() || found.as_array().empty()) {
    fail(key, "expected a list of strings, at least one");
  }
  for (const toml::value& each : found.as_array()) {
    if (!each.is_string()) {
      fail(key, "expected a list of strings");
    }
    all.push_back(each.as_string());
  }
  return all;
}

TomlTable TomlTable::table(const std::string& key) {
  const toml::value* found = find(key);
  return {file_, name_of(key), found == nullptr ? no_keys() : *found};
}

std::vector<TomlTable> TomlTable::tables(const std::string& key) {
  std::vector<TomlTable> all;
  if (const toml::value* found = find(key)) {
    if (!found->is_array()) {
      fail(key, "expected a list of tables");
    }
    for (const toml::value& each : found->as_array()) {
      all.emplace_back(file_, name_of(key) + "[" + std::to_string(all.size()) + "]", each);
    }
  }
  return all;
}

void TomlTable::no_other_keys() const {
  for (const auto& [key, value] : value_->as_table()) {
    if (accepted_.count(key) == 0) fail(key, "unknown key; accepted here: " + listed(accepted_));
  }
}

double TomlTable::number_of(const std::string& key, const toml::value& value, double low, double high) const {
  const double number = value.is_integer()    ? static_cast<double>(value.as_integer())
                        : value.is_floating() ? value.as_floating()
                                              : std::nan("");
  if (!(number >= low && number <= high)) {
    std::ostringstream limits;
    limits << "expected a number from " << low << " to " << high;
    fail(key, limits.str());
  }
  return number;
}

toml::value parse_toml(const std::filesystem::path& file) {
  std::istringstream text(whole_file(file, kTomlBytes));
  try {
    check_toml_shape(text.str());
    return toml::parse(text, file.string());
  } catch (const std::exception& error) {
    throw std::runtime_error(file.string() + ": TOML: " + error.what());
  }
}

void merge(toml::value& into, const toml::value& over) {
  if (!into.is_table() || !over.is_table()) {
    into = over;
    return;
  }
  for (const auto& [key, value] : over.as_table()) {
    toml::table& table = into.as_table();
    const auto found = table.find(key);
    if (found == table.end()) {
      table.emplace(key, value);
    } else {
      merge(found->second, value);
    }
  }
}

}  // namespace s4tp::scenario
