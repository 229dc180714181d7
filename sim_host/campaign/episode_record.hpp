#pragma once
/// Episodes on disk: a file of JSON lines. The first line says what campaign, program and part of it they
/// belong to; each further line is one finished episode, appended in one write, in the order they finished.

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "sim_host/campaign/campaign.hpp"

namespace s4tp::campaign {

/// \param parameters_file  for the commands that replay; may be empty
[[nodiscard]] nlohmann::ordered_json header_of(const Campaign& campaign, const Shard& shard,
                                               const std::string& parameters_file);

/// A cell to and from an array of its members.
[[nodiscard]] nlohmann::ordered_json cell_json(const Cell& cell);
[[nodiscard]] Cell cell_of(const nlohmann::ordered_json& json);

/// What two headers differ in, in words: "episodes: 100 there, 200 here"; empty: nothing.
/// \param but  a key that may differ
[[nodiscard]] std::string difference(const nlohmann::ordered_json& there, const nlohmann::ordered_json& here,
                                     const std::string& but = {});

/// One episode to and from its line. Numbers come back to the bit.
[[nodiscard]] nlohmann::ordered_json to_json(const EpisodeRow& row);
/// \throws std::exception when something is missing
[[nodiscard]] EpisodeRow row_of(const nlohmann::ordered_json& line);

struct Part {
  nlohmann::ordered_json header;
  std::vector<EpisodeRow> rows;
  std::uintmax_t whole_bytes = 0;  ///< of the file up to the last whole line
};

/// A last line that was cut off is left out. \throws std::runtime_error naming file and line
[[nodiscard]] Part read_part(const std::filesystem::path& file);

/// The file of a campaign that runs. Nobody else can have it open.
class EpisodeRecord {
 public:
  /// Begins the file, or goes on with what is in it.
  /// \throws std::runtime_error when it belongs to another campaign (naming the difference), to one that is
  /// running, or cannot be written
  EpisodeRecord(const std::filesystem::path& file, const nlohmann::ordered_json& header);
  ~EpisodeRecord();
  EpisodeRecord(const EpisodeRecord&) = delete;
  EpisodeRecord& operator=(const EpisodeRecord&) = delete;

  /// What was found in it.
  [[nodiscard]] const std::vector<EpisodeRow>& found() const { return found_; }
  /// \throws std::runtime_error when it cannot be written
  void append(const EpisodeRow& row);

 private:
  void write_line(const nlohmann::ordered_json& line);

  std::filesystem::path file_;
  int descriptor_ = -1;
  std::vector<EpisodeRow> found_;
};

}  // namespace s4tp::campaign
