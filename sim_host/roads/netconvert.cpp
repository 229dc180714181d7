#include "sim_host/roads/netconvert.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstring>
#include <fstream>
#include <pugixml.hpp>
#include <string>
#include <vector>

namespace s4tp::roads {
namespace {

namespace fs = std::filesystem;

/// Coordinates in millimetres: beyond what mathematical libraries may differ in.
std::string decimals(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3f", value);
  return text;
}

void save(const pugi::xml_document& document, const fs::path& file) {
  if (!document.save_file(file.c_str(), "  ")) {
    throw std::runtime_error(file.string() + ": cannot be written");
  }
}

void save_nodes(const PlainNetwork& network, const fs::path& file) {
  pugi::xml_document document;
  pugi::xml_node list = document.append_child("nodes");
  for (const PlainNode& node : network.nodes) {
    pugi::xml_node one = list.append_child("node");
    one.append_attribute("id") = node.id.c_str();
    one.append_attribute("x") = decimals(node.at.x).c_str();
    one.append_attribute("y") = decimals(node.at.y).c_str();
    one.append_attribute("type") = node.type.c_str();
    one.append_attribute("radius") = decimals(node.radius_m).c_str();
  }
  save(document, file);
}

void save_edges(const PlainNetwork& network, const fs::path& file) {
  pugi::xml_document document;
  pugi::xml_node list = document.append_child("edges");
  for (const PlainEdge& edge : network.edges) {
    pugi::xml_node one = list.append_child("edge");
    one.append_attribute("id") = edge.id.c_str();
    one.append_attribute("from") = edge.from.c_str();
    one.append_attribute("to") = edge.to.c_str();
    one.append_attribute("numLanes") = edge.lanes;
    one.append_attribute("speed") = decimals(edge.speed_mps).c_str();
    one.append_attribute("priority") = edge.priority;
    one.append_attribute("width") = decimals(kLaneWidth_m).c_str();
    if (edge.centred) {
      one.append_attribute("spreadType") = "center";
    }
    std::string shape;
    for (const map::Vec2 point : edge.shape) {
      shape += (shape.empty() ? "" : " ") + decimals(point.x) + ',' + decimals(point.y);
    }
    if (!shape.empty()) {
      one.append_attribute("shape") = shape.c_str();
    }
  }
  save(document, file);
}

void save_connections(const PlainNetwork& network, const fs::path& file) {
  pugi::xml_document document;
  pugi::xml_node list = document.append_child("connections");
  for (const PlainConnection& connection : network.connections) {
    pugi::xml_node one = list.append_child("connection");
    one.append_attribute("from") = connection.from.c_str();
    one.append_attribute("to") = connection.to.c_str();
    one.append_attribute("fromLane") = connection.from_lane;
    one.append_attribute("toLane") = connection.to_lane;
  }
  save(document, file);
}

/// \return exit code
int run(std::vector<std::string> command, const fs::path& log) {
  std::vector<char*> arguments;
  arguments.reserve(command.size() + 1);
  for (std::string& word : command) {
    arguments.push_back(word.data());
  }
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  posix_spawn_file_actions_adddup2(&files, STDOUT_FILENO, STDERR_FILENO);
  pid_t child = 0;
  const int why = posix_spawnp(&child, arguments[0], &files, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  if (why != 0) {
    throw std::runtime_error("starting " + command.front() + ": " + std::strerror(why) +
                             "; roads need Debian's package sumo (apt-get install sumo)");
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string last_line(const fs::path& file) {
  std::ifstream stream(file);
  std::string last;
  for (std::string line; std::getline(stream, line);) {
    if (!line.empty() && line != "Quitting (on error).") {
      last = line;
    }
  }
  return last;
}

}  // namespace

void write_network(const PlainNetwork& network, const fs::path& folder) {
  const fs::path nodes = folder / "plain.nod.xml";
  const fs::path edges = folder / "plain.edg.xml";
  const fs::path connections = folder / "plain.con.xml";
  const fs::path log = folder / "netconvert.log";
  const fs::path result = folder / "network.net.xml";
  save_nodes(network, nodes);
  save_edges(network, edges);
  save_connections(network, connections);
  const int code =
      run({"netconvert", "-n", nodes, "-e", edges, "-x", connections, "-o", result,
           // coordinates stay those drawn; curves in 20 points and 0.1 mm, so that curvature is smooth
           "--no-turnarounds", "true", "--offset.disable-normalization", "true",
           "--junctions.internal-link-detail", "20", "--precision", "4", "--xml-validation", "never"},
          log);
  const std::string words = last_line(log);
  for (const fs::path& file : {nodes, edges, connections, log}) {
    fs::remove(file);
  }
  if (code != 0) {
    throw Refused("netconvert: " + words);
  }
  pugi::xml_document document;  // read without comments: one of them holds date and paths
  if (!document.load_file(result.c_str())) {
    throw Refused("netconvert wrote no XML");
  }
  save(document, result);
}

}  // namespace s4tp::roads
