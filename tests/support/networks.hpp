#pragma once
/// SUMO networks for tests: written as text, or the shipped ones.

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "sim_host/world/scenario/scenario.hpp"

namespace s4tp::test {

/// A folder of its own that goes when the test does.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "s4tp-test-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) {
      throw std::runtime_error("no temporary folder");
    }
    path_ = name;
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() { std::filesystem::remove_all(path_); }

  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name) << text;
    return path_ / name;
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

inline map::Network network_of(const std::string& text) {
  const Folder folder;
  return map::load_network(folder.write("network.net.xml", text));
}

inline scenario::Scenario shipped(const std::string& name, const std::string& flavour = {}) {
  return scenario::load_scenario(std::filesystem::path(S4TP_SOURCE_DIR) / "sim_host/scenarios" / name,
                                 flavour);
}

inline const map::Lane& lane(const map::Network& network, const std::string& name) {
  return network.lanes.at(static_cast<std::size_t>(network.find(name)));
}

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos) {
    throw std::runtime_error("the text does not hold: " + from);
  }
  return text.replace(at, from.size(), to);
}

/// Two roads crossing at the origin at right angles, their junction lanes 20 m long: link 0 comes from the
/// west and must yield to link 1 from the south.
///
/// \code
///              north_out
///                 |
///   west_in ------+------ east_out
///                 |
///              south_in
/// \endcode
inline const std::string kCross = R"(<net>
  <edge id=":c_0" function="internal"><lane id=":c_0_0" index="0" speed="10" length="20" shape="-10,0 10,0"/></edge>
  <edge id=":c_1" function="internal"><lane id=":c_1_0" index="0" speed="10" length="20" shape="0,-10 0,10"/></edge>
  <edge id="west_in" from="w" to="c"><lane id="west_in_0" index="0" speed="10" length="40" shape="-50,0 -10,0"/></edge>
  <edge id="east_out" from="c" to="e"><lane id="east_out_0" index="0" speed="10" length="40" shape="10,0 50,0"/></edge>
  <edge id="south_in" from="s" to="c"><lane id="south_in_0" index="0" speed="10" length="40" shape="0,-50 0,-10"/></edge>
  <edge id="north_out" from="c" to="n"><lane id="north_out_0" index="0" speed="10" length="40" shape="0,10 0,50"/></edge>
  <junction id="c" type="priority" incLanes="west_in_0 south_in_0" intLanes=":c_0_0 :c_1_0">
    <request index="0" response="10" foes="10"/>
    <request index="1" response="00" foes="01"/>
  </junction>
  <connection from="west_in" to="east_out" fromLane="0" toLane="0" via=":c_0_0"/>
  <connection from="south_in" to="north_out" fromLane="0" toLane="0" via=":c_1_0"/>
  <connection from=":c_0" to="east_out" fromLane="0" toLane="0"/>
  <connection from=":c_1" to="north_out" fromLane="0" toLane="0"/>
</net>)";

/// Built without junction lanes: 10 m between two roads that go straight on.
inline const std::string kBridged = R"(<net>
    <edge id="a"><lane id="a_0" index="0" shape="0,0 50,0"/></edge>
    <edge id="b"><lane id="b_0" index="0" shape="60,0 9000,0"/></edge>
    <junction id="c" type="priority" incLanes="a_0" intLanes=""><request index="0" response="0" foes="0"/></junction>
    <connection from="a" to="b" fromLane="0" toLane="0"/></net>)";

}  // namespace s4tp::test
