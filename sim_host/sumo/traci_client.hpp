#pragma once
/// A TraCI client: one connection to one SUMO.

#include <chrono>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "sim_host/sumo/traci_message.hpp"

namespace s4tp::sumo::traci {

/// What variables belong to; the protocol's numbers of get, answer, set, subscribe and event follow from it.
enum class Domain : int { kVehicleType = 0x05, kRoute = 0x06, kVehicle = 0x04, kSimulation = 0x0B };

// Variables we use, and commands that look like variables.
inline constexpr int kPreviousSpeed = 0x3C;
inline constexpr int kSpeed = 0x40;
inline constexpr int kPosition = 0x42;  ///< front bumper's centre
inline constexpr int kAngle = 0x43;     ///< degrees clockwise from north
inline constexpr int kLength = 0x44;
inline constexpr int kWidth = 0x4D;
inline constexpr int kLaneId = 0x51;
inline constexpr int kAcceleration = 0x72;
inline constexpr int kDeparted = 0x74;  ///< ids, in the last step
inline constexpr int kArrived = 0x7A;   ///< ids, in the last step
inline constexpr int kAdd = 0x80;       ///< of routes
inline constexpr int kRemove = 0x81;
inline constexpr int kAddFull = 0x85;  ///< of vehicles
inline constexpr int kSpeedMode = 0xB3;
inline constexpr int kMoveToXy = 0xB4;
inline constexpr int kLaneChangeMode = 0xB6;
inline constexpr int kLateralPosition = 0xB8;  ///< from the lane's centre, left positive

using Variables = std::map<int, Value>;
/// Of each object subscribed to.
using Observations = std::map<std::string, Variables>;

class Client {
 public:
  /// \param socket   connected; the client closes it
  /// \param patience longest wait for an answer
  Client(int socket, std::chrono::milliseconds patience) : socket_(socket), patience_(patience) {}
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  // TRACI-002 All throw Error: with SUMO's own words where it refuses, when the connection ends, and when no
  // answer comes within the patience; nothing waits for ever.

  /// \return the version of SUMO's TraCI; `name` becomes SUMO's own
  int version(std::string& name);
  [[nodiscard]] Value get(Domain domain, int variable, const std::string& object);
  void set(Domain domain, int variable, const std::string& object, const Writer& value);
  /// From now on every step observes these; the answer is what they are now.
  Variables subscribe(Domain domain, const std::string& object, const std::vector<int>& variables);
  void unsubscribe(Domain domain, const std::string& object);
  /// One step. \return what has been subscribed to, of the objects still there
  std::map<Domain, Observations> step();
  /// Lets SUMO end by itself; never throws.
  void close() noexcept;

 private:
  /// Sends a command. \return what follows its status in the answer
  Reader exchange(int command, const Writer& content, const std::string& what);
  void send(const std::vector<std::uint8_t>& bytes);
  void receive(std::span<std::uint8_t> bytes);
  void wait_for(short events);

  int socket_;
  std::chrono::milliseconds patience_;
  std::vector<std::uint8_t> answer_;
};

}  // namespace s4tp::sumo::traci
