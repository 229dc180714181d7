#include "sim_host/campaign/any_ecu.hpp"
#include "sim_host/commands/drive.hpp"

namespace s4tp::commands {

Command add_eval(CLI::App& tool) {
  CLI::App* eval = tool.add_subcommand("eval", "a campaign of your choice");
  const auto options = std::make_shared<DriveOptions>();
  options->common.out = std::filesystem::path("out") / "eval";
  options->common.add_to(*eval);
  options->common.add_traffic_to(*eval);
  eval->add_option("--episodes", options->episodes, "per scenario and planner (default 20)")
      ->check(CLI::PositiveNumber);
  eval->add_option("--scenarios,--scenario", options->scenarios, "shipped names, folders or .toml files")
      ->delimiter(',');
  eval->add_option("--planners,--planner", options->planners, "who drives (default s4tp)")
      ->delimiter(',')
      ->check(CLI::IsMember(campaign::planner_names()));
  return {eval, [options] {
            (void)drive(*options);
            return kDone;
          }};
}

}  // namespace s4tp::commands
