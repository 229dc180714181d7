#include "sim_host/processes/own_files.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace s4tp::processes {
namespace {

namespace fs = std::filesystem;

fs::path own_path() {
  return fs::read_symlink("/proc/self/exe");
}

/// Empty: nowhere.
fs::path find_data(const std::string& name) {
  for (fs::path folder = own_path().parent_path();; folder = folder.parent_path()) {
    const fs::path data = folder / "share" / "s4tp" / name;
    if (fs::exists(data)) return fs::canonical(data);
    if (folder == folder.parent_path()) return {};
  }
}

}  // namespace

std::string own_program(const std::string& name) {
  return own_path().replace_filename(name);
}

bool has_own_data(const std::string& name) {
  return !find_data(name).empty();
}

fs::path own_data(const std::string& name) {
  const fs::path data = find_data(name);
  if (data.empty()) {
    throw std::runtime_error("share/s4tp/" + name + " is in no folder above " + own_path().string() +
                             ": the program's data are missing; build or install it anew");
  }
  return data;
}

void become(std::vector<std::string> command) {
  std::vector<char*> argv;
  for (std::string& word : command) argv.push_back(word.data());
  argv.push_back(nullptr);
  execv(argv[0], argv.data());
  throw std::runtime_error(command[0] + ": " + std::strerror(errno));
}

}  // namespace s4tp::processes
