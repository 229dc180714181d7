#include "sim_host/processes/ecu_child.hpp"

#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>

#include <cstring>
#include <filesystem>
#include <stdexcept>

extern char** environ;

namespace s4tp::processes {

EcuChild::EcuChild(const std::vector<std::string>& arguments) {
  const std::string program =
      std::filesystem::read_symlink("/proc/self/exe").replace_filename("s4tp_ecu_process");
  std::vector<char*> argv{const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  if (const int error = posix_spawn(&process_, program.c_str(), nullptr, nullptr, argv.data(), environ);
      error != 0) {
    throw std::runtime_error(program + ": " + std::strerror(error));
  }
}

EcuChild::~EcuChild() {
  if (!lives()) return;
  kill(process_, SIGTERM);
  waitpid(process_, nullptr, 0);
}

bool EcuChild::lives() {
  if (process_ > 0 && waitpid(process_, nullptr, WNOHANG) != 0) process_ = -1;
  return process_ > 0;
}

}  // namespace s4tp::processes
