#pragma once
/// netconvert (Debian package sumo): a SUMO network from plain XML.

#include <filesystem>
#include <stdexcept>

#include "sim_host/roads/road.hpp"

namespace s4tp::roads {

/// netconvert refused the network.
class Refused : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Writes FOLDER/network.net.xml, without what netconvert says about date and machine: the same network gives
/// the same bytes with the same netconvert. \param folder  exists; what was there in its name is replaced
/// \throws Refused with netconvert's last words \throws std::runtime_error when it cannot be started
void write_network(const PlainNetwork& network, const std::filesystem::path& folder);

}  // namespace s4tp::roads
