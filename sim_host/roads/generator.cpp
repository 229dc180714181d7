#include "sim_host/roads/generator.hpp"

#include <cmath>
#include <cstdio>
#include <fstream>
#include <numbers>
#include <stdexcept>

#include "sim_host/roads/mission_check.hpp"
#include "sim_host/roads/netconvert.hpp"
#include "sim_host/roads/road.hpp"
#include "sim_host/roads/scenario_toml.hpp"
#include "sim_host/world/scenario/scenario.hpp"

namespace s4tp::roads {
namespace {

namespace fs = std::filesystem;

constexpr int kDraws = 100;
constexpr double kAnywhere_m = 5000.0;

/// Turned about the origin, then shifted.
PlainNetwork placed(PlainNetwork network, double turn_rad, map::Vec2 at) {
  const auto place = [&](map::Vec2& point) {
    point = {at.x + point.x * std::cos(turn_rad) - point.y * std::sin(turn_rad),
             at.y + point.x * std::sin(turn_rad) + point.y * std::cos(turn_rad)};
  };
  for (PlainNode& node : network.nodes) {
    place(node.at);
  }
  for (PlainEdge& edge : network.edges) {
    for (map::Vec2& point : edge.shape) {
      place(point);
    }
  }
  return network;
}

/// Anywhere and in any direction.
Road draw(const Family& family, traffic::Random& random) {
  Road road = family.draw(random);
  const double turn_rad = random.uniform(0.0, 2.0 * std::numbers::pi);
  const double x_m = random.uniform(-kAnywhere_m, kAnywhere_m);
  const double y_m = random.uniform(-kAnywhere_m, kAnywhere_m);
  road.network = placed(std::move(road.network), turn_rad, {x_m, y_m});
  return road;
}

void write_text(const fs::path& file, const std::string& text) {
  std::ofstream stream(file);
  stream << text;
  stream.close();
  if (!stream) throw std::runtime_error(file.string() + ": cannot be written");
}

/// Writes it into `folder`. \return why it is no good; empty: it is
std::string refusal(const Road& road, const std::string& family, const fs::path& mix,
                    const fs::path& folder) {
  try {
    write_network(road.network, folder);
  } catch (const Refused&) {
    return "netconvert refuses it";
  }
  std::string text;
  try {
    text = scenario_toml(road, map::load_network(folder / "network.net.xml"), family);
  } catch (const std::runtime_error&) {
    return "a way leads nowhere";
  }
  write_text(folder / "scenario.toml", text);
  fs::copy_file(mix, folder / "social.toml", fs::copy_options::overwrite_existing);
  try {
    const scenario::Scenario smarts = scenario::load_scenario(folder);
    static_cast<void>(scenario::load_scenario(folder, "social"));
    return obstacle_of(smarts);
  } catch (const std::runtime_error&) {
    return "the scenario cannot be read";
  }
}

}  // namespace

WrittenRoad write_road(std::uint64_t number, const fs::path& mix, const fs::path& out) {
  const Family& family = families()[number % families().size()];
  char digits[24];
  std::snprintf(digits, sizeof digits, "_%05llu", static_cast<unsigned long long>(number));
  WrittenRoad written{family.name, out / (std::string(family.name) + digits), {}};
  const fs::path work = out / (std::string(".") + family.name + digits);
  fs::create_directories(work);
  traffic::Random random(number);
  for (int i = 0; i < kDraws; ++i) {
    const std::string reason = refusal(draw(family, random), family.name, mix, work);
    if (reason.empty()) {
      fs::remove_all(written.folder);
      fs::rename(work, written.folder);
      return written;
    }
    ++written.refused[reason];
  }
  throw std::runtime_error("road " + std::to_string(number) + ": none of " + std::to_string(kDraws) +
                           " draws is one to drive on");
}

std::string family_of(const std::string& scenario) {
  const std::size_t last = scenario.find_last_not_of("0123456789");
  const bool numbered =
      last != std::string::npos && last > 0 && last + 1 < scenario.size() && scenario[last] == '_';
  return numbered ? scenario.substr(0, last) : scenario;
}

}  // namespace s4tp::roads
