#include <iostream>
#include <limits>
#include <stdexcept>

#include "sim_host/campaign/digest.hpp"
#include "sim_host/campaign/records.hpp"
#include "sim_host/commands/command.hpp"
#include "sim_host/processes/stop_signals.hpp"
#include "sim_host/view/failure_replays.hpp"
#include "sim_host/view/report.hpp"

namespace s4tp::commands {
namespace {

namespace fs = std::filesystem;

struct ReportOptions {
  CommonOptions common;
  std::vector<fs::path> records;
  std::string replays = "3";
  int jobs = 0;
};

std::size_t most_of(const std::string& text) {
  if (text == "all") return std::numeric_limits<std::size_t>::max();
  if (!text.empty() && text.size() < 7 && text.find_first_not_of("0123456789") == std::string::npos) {
    return std::stoul(text);
  }
  throw std::invalid_argument("--replays " + text + ": accepted is a number, or all");
}

int write(ReportOptions& options) {
  view::ReplayOptions replays;
  replays.per_cell = most_of(options.replays);
  replays.threads = options.jobs;
  replays.scenario_root = options.common.scenario_root;
  replays.stop = &processes::stop_on_signals();
  const campaign::Records records = campaign::read_records(options.records);
  const OwnFolder own = options.common.choose_out();
  const fs::path& out = options.common.out;
  fs::create_directories(out);
  const fs::path folder = "replays";
  const view::Replays written = view::write_failure_replays(records, replays, out / folder);
  if (*replays.stop) return kInterrupted;

  view::Report report{records, written, folder, {}};
  const std::string build = campaign::build_digest();
  std::size_t other = 0;
  for (const auto& header : records.headers) other += header.at("build") != build ? 1 : 0;
  if (other > 0 && !written.empty()) {
    report.notes.push_back("The replays were driven with another build of the program (" + build +
                           ") than the campaign; each says whether it is still the same drive.");
  }
  view::write_report(report, out);

  std::size_t same = 0;
  for (const auto& [key, file] : written) same += file.changed.empty() ? 1 : 0;
  std::cout << records.done() << " of " << records.planned() << " episodes done\n"
            << written.size() << " replays, " << same
            << " to the same frame\nreport: " << (out / "index.html").string() << '\n';
  return same == written.size() ? kDone : kNotGoodEnough;
}

}  // namespace

Command add_eval_report(CLI::App& eval) {
  CLI::App* report = eval.add_subcommand("report", "a page with tables, plots and replays of failures");
  const auto options = std::make_shared<ReportOptions>();
  options->common.out = fs::path("out") / "report";
  report
      ->add_option(
          "records", options->records,
          "folders eval wrote to, or the records in them (.jsonl); of one or more campaigns, finished or not")
      ->required();
  options->common.out_named =
      report->add_option("--out", options->common.out, "folder of the page (default out/report)");
  report->add_option(
      "--replays", options->replays,
      "failures to show of each cell, those through our fault first: a number, or all (default 3)");
  report->add_option("--jobs", options->jobs, "episodes at a time (default: one a core)")
      ->check(CLI::PositiveNumber);
  report->add_option("--scenarios-folder", options->common.scenario_root, "where shipped scenarios lie");
  return {report, [options] { return write(*options); }};
}

}  // namespace s4tp::commands
