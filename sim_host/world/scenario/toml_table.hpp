#pragma once
/// Reading a TOML file of which every key is known: errors name the file, the key and what is accepted.

#include <filesystem>
#include <set>
#include <string>
#include <toml.hpp>
#include <vector>

#include "sim_host/world/scenario/traffic_demand.hpp"

namespace s4tp::scenario {

/// Every function throws std::runtime_error "FILE: KEY: what is accepted" when the value is none of these.
class TomlTable {
 public:
  /// \param file  as errors name it  \param path  of the table in the file; empty: the file itself
  TomlTable(std::string file, std::string path, const toml::value& value);

  [[noreturn]] void fail(const std::string& key, const std::string& what) const;
  [[nodiscard]] std::string name_of(const std::string& key) const;

  /// \return null when the key is missing
  [[nodiscard]] const toml::value* find(const std::string& key);
  [[nodiscard]] const toml::value& require(const std::string& key);

  [[nodiscard]] double number(const std::string& key, double missing, double low, double high);
  [[nodiscard]] int integer(const std::string& key, int missing, int low, int high);
  [[nodiscard]] bool boolean(const std::string& key, bool missing);
  [[nodiscard]] Range range(const std::string& key, double low, double high);  ///< a number, or [low, high]
  [[nodiscard]] std::string text(const std::string& key);
  [[nodiscard]] std::string text(const std::string& key, const std::string& missing);
  [[nodiscard]] std::vector<std::string> texts(const std::string& key);  ///< at least one
  [[nodiscard]] TomlTable table(const std::string& key);                 ///< empty when missing
  [[nodiscard]] std::vector<TomlTable> tables(const std::string& key);   ///< a list of them

  /// Fails on a key that nobody has asked for, naming those that were.
  void no_other_keys() const;

 private:
  double number_of(const std::string& key, const toml::value& value, double low, double high) const;

  std::string file_;
  std::string path_;
  const toml::value* value_;
  std::set<std::string> accepted_;
};

/// \throws std::runtime_error naming the file
[[nodiscard]] toml::value parse_toml(const std::filesystem::path& file);

/// Puts the values of one document over those of another: tables are merged, anything else is replaced.
void merge(toml::value& into, const toml::value& over);

}  // namespace s4tp::scenario
