#include <iostream>

#include "sim_host/campaign/reference_drive.hpp"
#include "sim_host/commands/command.hpp"

namespace s4tp::commands {

Command add_record(CLI::App& tool) {
  CLI::App* record = tool.add_subcommand("record", "the reference drive that every target must reproduce");
  struct Options {
    CommonOptions common;
    std::filesystem::path log;
  };
  const auto options = std::make_shared<Options>();
  record->add_option("--out", options->log, "the log to write")->required();
  record->add_option("--scenarios-folder", options->common.scenario_root, "where shipped scenarios lie");
  return {record, [options] {
            const std::uint64_t seed =
                campaign::record_reference_drive(options->common.find_scenario("left_turn"), options->log);
            std::cout << options->log.string() << ": left_turn seed " << seed
                      << " with a stop, a restart, a lane change, a degraded mode and a missed deadline\n";
            return kDone;
          }};
}

}  // namespace s4tp::commands
