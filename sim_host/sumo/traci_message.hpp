#pragma once
/// TraCI's bytes: big-endian numbers, length-prefixed text, a type byte before each value.
/// Protocol: https://sumo.dlr.de/docs/TraCI/Protocol.html

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "sim_host/world/map/polyline.hpp"

namespace s4tp::sumo::traci {

/// SUMO refused something, answered what TraCI does not know, or is gone.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What TraCI's typed values become here; anything else is an error.
using Value = std::variant<int, double, std::string, std::vector<std::string>, map::Vec2>;

class Writer {
 public:
  // Plain, as the protocol's own fields are.
  Writer& byte(int value);
  Writer& integer(int value);
  Writer& real(double value);
  Writer& text(const std::string& value);
  // With their type byte, as values of variables are.
  Writer& typed_byte(int value);
  Writer& typed_integer(int value);
  Writer& typed_real(double value);
  Writer& typed_text(const std::string& value);
  Writer& typed_texts(const std::vector<std::string>& value);
  Writer& compound(int items);  ///< its items follow
  Writer& append(const Writer& other);

  [[nodiscard]] const std::vector<std::uint8_t>& bytes() const { return bytes_; }

 private:
  std::vector<std::uint8_t> bytes_;
};

/// Every read beyond the end or of an unknown type throws Error.
class Reader {
 public:
  explicit Reader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  int byte();
  int integer();
  double real();
  std::string text();
  Value typed();
  /// The next command or result: takes its length (one byte, or 0 and four) off and gives what is in it.
  Reader command();
  [[nodiscard]] bool at_end() const { return bytes_.empty(); }

 private:
  std::span<const std::uint8_t> take(std::size_t count);
  std::size_t count();

  std::span<const std::uint8_t> bytes_;
};

/// TRACI-001 A message of one command: four bytes of length, then the command with its own length.
[[nodiscard]] std::vector<std::uint8_t> message(int command, const Writer& content);

}  // namespace s4tp::sumo::traci
