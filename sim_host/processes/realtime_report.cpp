#include "sim_host/processes/realtime_report.hpp"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace s4tp::processes {
namespace {

using hal::linux_host::LatencyHistogram;
using nlohmann::json;

constexpr std::uint32_t kMedian = 5000;
constexpr std::uint32_t kP99 = 9900;
constexpr std::uint32_t kP999 = 9990;
constexpr std::uint32_t kFirstRow_us = 16;
constexpr std::uint32_t kLastRow_us = 1U << 24;
constexpr std::uint32_t kBar = 50;

/// From, to [us], count: one row for each power of two, from the first that is not empty to the last.
struct Row {
  std::uint32_t from_us;
  std::uint32_t to_us;
  std::uint32_t count;
};

std::vector<Row> rows_of(const LatencyHistogram& histogram) {
  std::vector<Row> rows;
  std::uint32_t from_us = 0;
  for (std::uint32_t to_us = kFirstRow_us; from_us < kLastRow_us; from_us = to_us, to_us *= 2)
    rows.push_back({from_us, to_us, histogram.count_in(from_us, to_us)});
  const auto filled = [](const Row& row) { return row.count > 0; };
  rows.erase(rows.begin(), std::find_if(rows.begin(), rows.end(), filled));
  rows.erase(std::find_if(rows.rbegin(), rows.rend(), filled).base(), rows.end());
  return rows;
}

void print_rows(std::ostream& out, const LatencyHistogram& histogram) {
  const std::vector<Row> rows = rows_of(histogram);
  std::uint32_t most = 1;
  for (const Row& row : rows) most = std::max(most, row.count);
  for (const Row& row : rows) {
    char text[80];
    std::snprintf(text, sizeof text, "  %8u .. %8u us %8u  ", row.from_us, row.to_us - 1, row.count);
    const std::uint64_t bar = (std::uint64_t{row.count} * kBar + most - 1) / most;
    out << text << std::string(bar, '#') << '\n';
  }
}

json to_json(const LatencyHistogram& histogram) {
  json rows = json::array();
  for (const Row& row : rows_of(histogram)) rows.push_back({row.from_us, row.to_us, row.count});
  return {{"count", histogram.count()},
          {"min_us", histogram.min_us()},
          {"median_us", histogram.quantile_us(kMedian)},
          {"p99_us", histogram.quantile_us(kP99)},
          {"p99_9_us", histogram.quantile_us(kP999)},
          {"max_us", histogram.max_us()},
          {"from_to_count", rows}};
}

}  // namespace

std::vector<std::string> objections(const RealtimeReport& report) {
  std::vector<std::string> result;
  const LatencyHistogram& late = report.wake_ups;
  if (late.count() < kEnoughWakeUps)
    result.push_back("only " + std::to_string(late.count()) + " wake-ups, " + std::to_string(kEnoughWakeUps) +
                     " are needed to judge by");
  if (const std::uint32_t p999_us = late.quantile_us(kP999); p999_us >= kLate_us)
    result.push_back("p99.9 of the wake-ups is " + std::to_string(p999_us) +
                     " us late, allowed is less than " + std::to_string(kLate_us));
  if (late.slips() > 0) result.push_back(std::to_string(late.slips()) + " slips, allowed is none");
  for (const hal::linux_host::Grant& grant : report.grants) {
    if (!grant.granted) result.push_back(std::string(grant.what) + " refused");
  }
  if (report.kernel.model == hal::linux_host::Preemption::kWeak)
    result.push_back("the kernel's preemption is of a weak kind");
  return result;
}

void print(std::ostream& out, const RealtimeReport& report) {
  const LatencyHistogram& late = report.wake_ups;
  out << report.task << ": " << late.count() << " wake-ups, late by " << late.min_us()
      << " us at least, median " << late.quantile_us(kMedian) << ", p99 " << late.quantile_us(kP99)
      << ", p99.9 " << late.quantile_us(kP999) << ", max " << late.max_us() << "; " << late.slips()
      << " slips\n";
  print_rows(out, late);
  if (report.planning.count() > 0) {
    out << "  planning: " << report.planning.count() << " cycles, median "
        << report.planning.quantile_us(kMedian) << " us, p99 " << report.planning.quantile_us(kP99)
        << ", max " << report.planning.max_us() << "; " << report.deadline_misses << " deadlines missed\n";
  }
  for (const hal::linux_host::Grant& grant : report.grants) {
    out << "  " << grant.what << ": " << (grant.granted ? "granted" : "refused, ") << grant.reason << '\n';
    if (!grant.granted) out << "    remedy: " << grant.remedy << '\n';
  }
  out << "  kernel preemption: " << hal::linux_host::preemption_name(report.kernel.model) << " ("
      << report.kernel.source << ")\n";
  const std::vector<std::string> against = objections(report);
  out << "  this machine is " << (against.empty() ? "fit" : "NOT FIT") << " for real time, as far as "
      << report.task << " goes" << (against.empty() ? "" : ":") << '\n';
  for (const std::string& reason : against) out << "    - " << reason << '\n';
  out.flush();
}

json to_json(const RealtimeReport& report) {
  const std::vector<std::string> against = objections(report);
  json result{{"fit", against.empty()},
              {"objections", against},
              {"slips", report.wake_ups.slips()},
              {"wake_up_latency", to_json(report.wake_ups)},
              {"kernel_preemption", hal::linux_host::preemption_name(report.kernel.model)},
              {"kernel_preemption_source", report.kernel.source},
              {"requests", json::array()}};
  for (const hal::linux_host::Grant& grant : report.grants)
    result["requests"].push_back({{"what", grant.what},
                                  {"granted", grant.granted},
                                  {"reason", grant.reason},
                                  {"remedy", grant.remedy}});
  if (report.planning.count() > 0) {
    result["planning_duration"] = to_json(report.planning);
    result["deadline_misses"] = report.deadline_misses;
  }
  return result;
}

}  // namespace s4tp::processes
