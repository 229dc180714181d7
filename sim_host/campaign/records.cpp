#include "sim_host/campaign/records.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>

#include "sim_host/campaign/episode_record.hpp"
#include "sim_host/campaign/parameters_file.hpp"
#include "sim_host/campaign/record_limits.hpp"

namespace s4tp::campaign {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

std::vector<fs::path> record_files(const std::vector<fs::path>& paths) {
  std::vector<fs::path> files;
  for (const fs::path& path : paths) {
    if (!fs::exists(path)) throw std::runtime_error(path.string() + ": there is no such file or folder");
    const fs::path folder = fs::is_directory(path)        ? path
                            : path.extension() == ".json" ? fs::absolute(path).parent_path()
                                                          : fs::path();
    if (folder.empty()) {
      files.push_back(path);
      continue;
    }
    std::vector<fs::path> found;
    for (const auto& entry : fs::directory_iterator(folder)) {
      if (entry.path().extension() == ".jsonl") found.push_back(entry.path());
    }
    if (found.empty()) {
      throw std::runtime_error(folder.string() +
                               ": holds no record of episodes (.jsonl); eval leaves it in its --out");
    }
    std::sort(found.begin(), found.end());
    files.insert(files.end(), found.begin(), found.end());
  }
  return files;
}

/// From the first to behind the last.
using Seeds = std::pair<std::uint64_t, std::uint64_t>;

/// How many there are; what is in several counts once.
std::size_t count(std::vector<Seeds> ranges) {
  std::sort(ranges.begin(), ranges.end());
  std::uint64_t counted_to = 0;
  std::uint64_t sum = 0;
  for (const auto& [first, end] : ranges) {
    const std::uint64_t from = std::max(first, counted_to);
    sum += end > from ? end - from : 0;
    counted_to = std::max(counted_to, end);
  }
  return sum;
}

Records joined(std::vector<ordered_json> headers, const std::vector<EpisodeRow>& rows) {
  std::map<Cell, std::vector<Seeds>> planned;
  std::map<Cell, CellResult> results;
  for (CellResult& result : collect(rows)) results.emplace(result.cell, std::move(result));
  Records records;
  for (const ordered_json& header : headers) {
    const auto first_seed = header.at("first_seed").get<std::uint64_t>();
    for (const ordered_json& json : header.at("cells")) {
      const Cell cell = cell_of(json);
      if (!planned.contains(cell)) records.cells.push_back({{cell, {}, {}}, 0});
      planned[cell].emplace_back(first_seed, first_seed + header.at("episodes").get<std::uint64_t>());
    }
  }
  for (ReportedCell& cell : records.cells) {
    cell.planned = count(planned.at(cell.result.cell));
    const auto found = results.find(cell.result.cell);
    if (found != results.end()) cell.result = std::move(found->second);
  }
  records.headers = std::move(headers);
  return records;
}

}  // namespace

std::size_t Records::done() const {
  std::size_t sum = 0;
  for (const ReportedCell& cell : cells) sum += cell.result.episodes.size();
  return sum;
}

std::size_t Records::planned() const {
  std::size_t sum = 0;
  for (const ReportedCell& cell : cells) sum += cell.planned;
  return sum;
}

Records read_records(const std::vector<fs::path>& paths) {
  std::vector<ordered_json> headers;
  std::vector<EpisodeRow> rows;
  for (const fs::path& file : record_files(paths)) {
    Part part = read_part(file);
    if (part.header.is_null()) throw std::runtime_error(file.string() + ": holds nothing");
    const bool known = std::any_of(headers.begin(), headers.end(), [&](const ordered_json& header) {
      return difference(header, part.header, "shard").empty() &&
             header.at("cells") == part.header.at("cells");
    });
    if (!known) headers.push_back(std::move(part.header));
    rows.insert(rows.end(), part.rows.begin(), part.rows.end());
  }
  check_poolable(headers);
  return joined(std::move(headers), rows);
}

Records records_of(const ordered_json& header, const std::vector<EpisodeRow>& rows) {
  return joined({header}, rows);
}

CampaignPlan plan_of(const ordered_json& header) {
  CampaignPlan plan;
  header.at("planners").get_to(plan.planners);
  plan.scenarios.clear();
  for (const ordered_json& scenario : header.at("scenarios")) {
    const std::string argument = scenario.at("argument");
    if (std::find(plan.scenarios.begin(), plan.scenarios.end(), argument) == plan.scenarios.end()) {
      plan.scenarios.push_back(argument);
    }
  }
  header.at("flavours").get_to(plan.flavours);
  header.at("traffic").get_to(plan.traffic);
  plan.guards.clear();
  for (const ordered_json& guard : header.at("guard")) plan.guards.push_back(guard == "on");
  header.at("perception").get_to(plan.perception);
  header.at("episodes").get_to(plan.episodes);
  header.at("first_seed").get_to(plan.first_seed);
  const std::string parameters = header.at("parameters");
  if (!parameters.empty()) plan.parameters = load_parameters(parameters);
  return plan;
}

std::string replay_command(const ordered_json& header, const Cell& cell, std::uint64_t seed) {
  std::string argument = cell.scenario;
  for (const ordered_json& scenario : header.at("scenarios")) {
    if (scenario.at("name") == cell.scenario) argument = scenario.at("argument").get<std::string>();
  }
  return replay_command(cell, argument, header.at("parameters"), seed);
}

}  // namespace s4tp::campaign
