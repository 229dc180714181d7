// What a drive's telemetry takes on loopback: rates, sizes, loss and latency of each topic, beside ddsperf's.

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "sim_host/campaign/progress.hpp"
#include "sim_host/processes/child_process.hpp"
#include "sim_host/processes/own_folder.hpp"
#include "sim_host/telemetry/live_drive.hpp"
#include "sim_host/world/scenario/scenario.hpp"
#include "tests/benchmark/dds_subscriber.hpp"
#include "tests/benchmark/ddsperf.hpp"
#include "tests/support/test_memory.hpp"

namespace {

using namespace s4tp;
using benchmark::at;
using benchmark::ddsperf;
using benchmark::DdsSubscriber;
using benchmark::RecordTimes;
using benchmark::Reference;
using benchmark::TopicSamples;
using telemetry::DdsPublisher;
namespace fs = std::filesystem;

constexpr double kMostLost = 0.01;  // share of all messages

/// A drive at the pace of the clock whose ECU notes when it told what.
class NotedDrive final : public campaign::Onlooker, public hal::Telemetry {
 public:
  explicit NotedDrive(const std::string& memory) : live_(memory, "s4tp", Parameters{}) {}
  void begin(campaign::Trace* trace) override { live_.begin(trace); }
  hal::Telemetry* telemetry() override { return this; }
  planner::Probe* probe() override { return live_.probe(); }
  void ticked(const campaign::Driver& driver) override { live_.ticked(driver); }
  bool publish(std::uint16_t kind, const void* record, std::uint32_t size) override {
    if (static_cast<ecu::RecordKind>(kind) == ecu::RecordKind::kPlan)
      plans.note(static_cast<const ecu::PlanRecord*>(record)->plan.start_ms);
    if (static_cast<ecu::RecordKind>(kind) == ecu::RecordKind::kControl)
      commands.note(static_cast<const ecu::ControlRecord*>(record)->time_ms);
    return live_.telemetry()->publish(kind, record, size);
  }

  RecordTimes plans;
  RecordTimes commands;

 private:
  telemetry::LiveDrive live_;
};

struct Row {
  std::string topic;
  double rate_hz = 0.0;
  double bytes = 0.0;  ///< mean
  std::uint32_t most_bytes = 0;
  long sent = 0;
  long received = 0;
  TopicSamples samples;
};

/// What s4tp-telemetry says at its end: "N x TOPIC".
long sent_of(const fs::path& said, const std::string& topic) {
  std::ifstream file(said);
  for (std::string line; std::getline(file, line);) {
    const std::size_t at = line.find(" x " + topic);
    if (at != std::string::npos && line.size() == at + 3 + topic.size()) return std::stol(line);
  }
  throw std::runtime_error("s4tp-telemetry does not say how many messages it sent on " + topic);
}

Row row_of(telemetry::Topic topic, const DdsSubscriber& subscriber, const fs::path& said) {
  Row row;
  row.topic = DdsPublisher::name(topic);
  row.samples = subscriber.samples(topic);
  row.sent = sent_of(said, row.topic);
  const auto& bytes = row.samples.bytes;
  row.received = static_cast<long>(bytes.size());
  if (bytes.empty()) return row;
  row.bytes = std::accumulate(bytes.begin(), bytes.end(), 0.0) / static_cast<double>(bytes.size());
  row.most_bytes = *std::max_element(bytes.begin(), bytes.end());
  const double time_s = static_cast<double>(row.samples.last_ns - row.samples.first_ns) * 1e-9;
  if (time_s > 0.0) row.rate_hz = static_cast<double>(row.received - 1) / time_s;
  return row;
}

void print_latency(const std::vector<double>& values) {
  for (const double share : {0.5, 0.99, 1.0}) std::cout << std::setw(9) << std::lround(at(values, share));
}

void print(const std::vector<Row>& rows, const std::vector<Reference>& references) {
  std::cout
      << "\n                                   bytes                               after the write [us]\n"
      << "topic                       Hz      mean     most     sent     lost   median      p99     most\n"
      << std::fixed;
  for (const Row& row : rows) {
    std::cout << std::left << std::setw(24) << row.topic << std::right << std::setprecision(1) << std::setw(6)
              << row.rate_hz << std::setw(10) << std::lround(row.bytes) << std::setw(9) << row.most_bytes
              << std::setw(9) << row.sent << std::setw(9) << row.sent - row.received;
    print_latency(row.samples.after_write_us);
    std::cout << '\n';
  }
  std::cout
      << "\nfrom the ECU's record to the subscriber [us]                     median      p99     most\n";
  for (const Row& row : rows) {
    if (row.samples.after_record_us.empty()) continue;
    std::cout << std::left << std::setw(62) << row.topic << std::right;
    print_latency(row.samples.after_record_us);
    std::cout << '\n';
  }
  if (!references.empty()) std::cout << "\nddsperf: half a round trip at 10 Hz; sent and lost at 100 Hz\n";
  for (const Reference& reference : references) {
    std::cout << std::setw(40) << reference.bytes << std::setw(18) << reference.sent << std::setw(9)
              << reference.lost << std::setw(9) << std::lround(reference.median_us) << std::setw(18)
              << std::lround(reference.most_us) << '\n';
  }
}

nlohmann::ordered_json json_of(const std::vector<Row>& rows, const std::vector<Reference>& references) {
  const auto latency = [](const std::vector<double>& values) {
    return nlohmann::ordered_json{
        {"median_us", at(values, 0.5)}, {"p99_us", at(values, 0.99)}, {"most_us", at(values, 1.0)}};
  };
  nlohmann::ordered_json json;
  for (const Row& row : rows) {
    nlohmann::ordered_json one = {{"topic", row.topic},
                                  {"rate_hz", row.rate_hz},
                                  {"bytes_mean", row.bytes},
                                  {"bytes_most", row.most_bytes},
                                  {"sent", row.sent},
                                  {"received", row.received},
                                  {"after_write", latency(row.samples.after_write_us)}};
    if (!row.samples.after_record_us.empty()) one["after_record"] = latency(row.samples.after_record_us);
    json["topics"].push_back(one);
  }
  for (const Reference& reference : references) {
    json["ddsperf"].push_back({{"bytes", reference.bytes},
                               {"median_us", reference.median_us},
                               {"most_us", reference.most_us},
                               {"sent", reference.sent},
                               {"lost", reference.lost}});
  }
  return json;
}

struct Options {
  std::string scenario = "merge";
  std::uint64_t seed = 3;
  double seconds = 60.0;
  int ddsperf_s = 10;
  fs::path out = "out/bench_dds";
};

/// Drives until the goal or the time limit, and reads all the while.
std::vector<Row> measure(const Options& options, std::uint32_t domain) {
  const std::string memory = tests::test_memory("dds_bench");
  const fs::path said = options.out / "telemetry.txt";
  DdsSubscriber subscriber(domain);
  NotedDrive drive(memory);
  std::optional<processes::ChildProcess> telemetry;
  telemetry.emplace(std::vector<std::string>{
      "sh", "-c", "exec \"$0\" --ecu " + memory + " --domain " + std::to_string(domain) + " >\"$1\"",
      std::string(S4TP_BINARY_DIR) + "/sim_host/s4tp-telemetry", said.string()});
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (!subscriber.matched()) {
    if (std::chrono::steady_clock::now() > end)
      throw std::runtime_error("s4tp-telemetry's topics are not found");
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  std::this_thread::sleep_for(std::chrono::seconds(1));  // the other side may learn of its readers later

  scenario::Scenario scenario =
      scenario::load_scenario(fs::path(S4TP_SOURCE_DIR) / "sim_host/scenarios" / options.scenario);
  scenario.mission.time_limit_s = std::min(scenario.mission.time_limit_s, options.seconds);
  std::atomic<bool> over = false;
  std::exception_ptr failed;
  std::thread driving([&] {
    try {
      campaign::EpisodeOptions episode;
      episode.seed = options.seed;
      episode.onlooker = &drive;
      (void)campaign::run_episode(scenario, episode);
    } catch (...) {
      failed = std::current_exception();
    }
    over = true;
  });
  const double most_s = scenario.mission.time_limit_s;
  campaign::ConsoleProgress progress(static_cast<std::size_t>(std::ceil(most_s)));
  for (double told_s = 0.0; !over;) {
    subscriber.take(drive.plans, drive.commands);
    for (; told_s < std::min(progress.elapsed_s(), most_s); told_s += 1.0)
      progress.done("seconds of driving at most");
  }
  progress.end();
  driving.join();
  if (failed) std::rethrow_exception(failed);
  for (int i = 0; i < 3; ++i) subscriber.take(drive.plans, drive.commands);
  telemetry.reset();  // it says its last words first
  double load = 0.0;
  (void)getloadavg(&load, 1);
  std::cout << "load average " << std::setprecision(2) << load << " on "
            << std::thread::hardware_concurrency() << " processors; the ECU told " << drive.plans.count()
            << " plans and " << drive.commands.count() << " commands\n";
  std::vector<Row> rows;
  for (int i = 0; i < telemetry::kTopicCount; ++i)
    rows.push_back(row_of(static_cast<telemetry::Topic>(i), subscriber, said));
  return rows;
}

/// ddsperf's figures for messages as long as those of three topics.
std::vector<Reference> refer(const std::vector<Row>& rows, int seconds, std::uint32_t domain) {
  constexpr telemetry::Topic kTopics[] = {telemetry::kControlTopic, telemetry::kTrajectoryTopic,
                                          telemetry::kCandidatesTopic};
  setenv("CYCLONEDDS_URI", telemetry::dds_configuration("").c_str(), 0);
  campaign::ConsoleProgress progress(std::size(kTopics));
  std::vector<Reference> references;
  for (const telemetry::Topic topic : kTopics) {
    references.push_back(ddsperf(static_cast<int>(std::lround(rows[topic].bytes)), seconds, domain));
    progress.done("ddsperf for " + rows[topic].topic);
  }
  progress.end();
  return references;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "What a drive's telemetry takes on loopback: rates, sizes, loss and latency of each topic, beside "
      "ddsperf's "
      "(docs/telemetry.md).\nexit code: 0 at most 1 % of the messages lost, 1 more, 2 cannot be judged",
      "./s4tp bench dds");
  Options options;
  app.add_option("--scenario", options.scenario, "shipped name (default merge)");
  app.add_option("--seed", options.seed, "(default 3)");
  app.add_option("--seconds", options.seconds, "of driving at most (default 60)")->check(CLI::PositiveNumber);
  app.add_option("--ddsperf", options.ddsperf_s,
                 "seconds for each of ddsperf's figures (default 10; 0: without)")
      ->check(CLI::NonNegativeNumber);
  const CLI::Option* const out_named =
      app.add_option("--out", options.out, "folder for results.json (default out/bench_dds)");
  CLI11_PARSE(app, argc, argv);
  try {
    const processes::OwnFolder own = processes::choose_folder(options.out, out_named->count() > 0);
    fs::create_directories(options.out);
    const std::uint32_t domain = 20U + static_cast<std::uint32_t>(getpid()) % 200U;
    const std::vector<Row> rows = measure(options, domain);
    const std::vector<Reference> references =
        options.ddsperf_s > 0 ? refer(rows, options.ddsperf_s, domain) : std::vector<Reference>();
    print(rows, references);
    const fs::path json = options.out / "results.json";
    if (!(std::ofstream(json) << json_of(rows, references).dump(2) << '\n'))
      throw std::runtime_error(json.string() + ": cannot be written");
    long sent = 0;
    long received = 0;
    for (const Row& row : rows) {
      sent += row.sent;
      received += row.received;
      if (row.received == 0) throw std::runtime_error("nothing came on " + row.topic);
    }
    return static_cast<double>(sent - received) <= kMostLost * static_cast<double>(sent) ? 0 : 1;
  } catch (const std::exception& error) {
    std::cerr << "dds_bench: " << error.what() << '\n';
    return 2;
  }
}
