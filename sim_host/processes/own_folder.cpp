#include "sim_host/processes/own_folder.hpp"

#include <iostream>
#include <string>
#include <system_error>

namespace s4tp::processes {

OwnFolder::~OwnFolder() {
  std::error_code not_empty;
  if (!made_.empty()) std::filesystem::remove(made_, not_empty);
}

OwnFolder choose_folder(std::filesystem::path& folder, bool named) {
  if (named) return {};
  const std::filesystem::path wanted = folder;
  if (wanted.has_parent_path()) std::filesystem::create_directories(wanted.parent_path());
  for (int i = 2; !std::filesystem::create_directory(folder); ++i) {
    folder = wanted;
    folder += "-" + std::to_string(i);
  }
  if (folder != wanted)
    std::cerr << "note: " << wanted.string() << " holds a result already; this one goes to "
              << folder.string() << '\n';
  return OwnFolder(folder);
}

}  // namespace s4tp::processes
