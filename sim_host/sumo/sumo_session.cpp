#include "sim_host/sumo/sumo_session.hpp"

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <stdexcept>
#include <thread>
#include <vector>

#include "sim_host/sumo/sumo_routes.hpp"
#include "sim_host/world/traffic/traffic_flow.hpp"

namespace s4tp::sumo {
namespace {

using namespace std::chrono_literals;
using std::chrono::steady_clock;

constexpr auto kPatience = 60s;  // for any answer, loading a large network included
constexpr int kAttempts = 5;

/// A loopback port nobody else gets while this object lives, but which SUMO may bind: held without listening,
/// by a socket that lets addresses be used again.
class ReservedPort {
 public:
  ReservedPort() : socket_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    socklen_t size = sizeof address;
    const int yes = 1;
    if (socket_ < 0 || bind(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0 ||
        getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size) != 0 ||
        setsockopt(socket_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes) != 0) {
      throw std::runtime_error(std::string("a port for SUMO: ") + std::strerror(errno));
    }
    number_ = ntohs(address.sin_port);
  }
  ~ReservedPort() { close(socket_); }
  ReservedPort(const ReservedPort&) = delete;
  ReservedPort& operator=(const ReservedPort&) = delete;

  [[nodiscard]] int number() const { return number_; }

 private:
  int socket_;
  int number_ = 0;
};

/// \return -1: nobody listens there
int connect_to(int port) {
  const int connection = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (connection >= 0 && connect(connection, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0) {
    close(connection);
    return -1;
  }
  return connection;
}

std::vector<std::string> arguments(const scenario::Scenario& scenario,
                                   const traffic::EngineOptions& options) {
  std::vector<std::string> all{"--net-file", scenario.network_file.string()};
  if (scenario.route_files.empty()) {
    all.insert(all.end(), {"--route-files", "/dev/stdin"});
  } else {
    const std::size_t file = options.episode % scenario.route_files.size();
    all.insert(all.end(),
               {"--route-files", scenario.route_files[file].string(), "--additional-files", "/dev/stdin"});
  }
  const std::uint64_t seed = traffic::next_seed(options.seed ^ 0x5030) & 0x7FFFFFFFU;
  all.insert(all.end(), {"--seed",
                         std::to_string(seed),
                         "--step-length",
                         "0.1",
                         "--default.action-step-length",
                         "0.1",
                         "--time-to-teleport",
                         "-1",
                         "--collision.check-junctions",
                         "true",
                         "--collision.action",
                         "none",
                         "--lanechange.duration",
                         "3.0",
                         "--tls.all-off",
                         "true",  // the world's rule: priorities hold, signals do not
                         "--no-step-log",
                         "true",
                         "--no-warnings",
                         "true",
                         "--duration-log.disable",
                         "true",
                         "--xml-validation",
                         "never",
                         "--precision",
                         "6"});
  return all;
}

std::string definitions(const scenario::Scenario& scenario, std::uint64_t seed, const std::string& driver) {
  check_names(scenario);
  const traffic::CarState car;
  std::string text = ego_definitions(scenario.mission.edges, car.length_m, car.width_m, driver);
  if (scenario.route_files.empty()) {
    traffic::Random random(seed);
    text += flow_definitions(scenario.network, traffic::draw_flows(scenario.network, scenario.flows,
                                                                   traffic::kDrawnUntil_s, random));
  }
  return routes_file(text);
}

}  // namespace

Session start_sumo(const scenario::Scenario& scenario, const traffic::EngineOptions& options,
                   const std::string& driver) {
  const std::vector<std::string> asked = arguments(scenario, options);
  const std::string input = definitions(scenario, options.seed, driver);
  std::string words;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const ReservedPort port;
    std::vector<std::string> all = asked;
    all.insert(all.end(), {"--remote-port", std::to_string(port.number()), "--num-clients", "1"});
    Session session;
    session.process = std::make_unique<Process>("sumo", all, input);
    const auto end = steady_clock::now() + kPatience;
    int connection = -1;
    while (connection < 0 && session.process->lives() && steady_clock::now() < end) {
      connection = connect_to(port.number());
      if (connection < 0) {
        std::this_thread::sleep_for(2ms);
      }
    }
    if (connection >= 0) {
      session.client = std::make_unique<traci::Client>(connection, kPatience);
      return session;
    }
    words = session.process->last_words();
    if (words.find("in use") == std::string::npos) {
      break;
    }
  }
  throw std::runtime_error("SUMO does not come up; its last words: " + words);
}

}  // namespace s4tp::sumo
