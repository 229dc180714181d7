#include "sim_host/commands/vcan_machine.hpp"

#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <iostream>
#include <stdexcept>
#include <utility>

#include "hal/linux/bus_name.hpp"
#include "sim_host/processes/log_follower.hpp"
#include "sim_host/processes/own_files.hpp"
#include "sim_host/processes/stop_signals.hpp"

namespace s4tp::commands {
namespace {

namespace fs = std::filesystem;

constexpr useconds_t kLook_us = 10'000;
constexpr const char* kSeconds = "3600";  // a drive takes minutes at most

bool kernel_has_can() {
  const int probe = socket(PF_CAN, SOCK_RAW, 1);  // CAN_RAW
  const bool has = probe >= 0 || (errno != EAFNOSUPPORT && errno != EPROTONOSUPPORT);
  if (probe >= 0) close(probe);
  return has;
}

}  // namespace

bool needs_machine(const std::string& bus, bool asked_for) {
  hal::linux_host::BusName name;
  hal::linux_host::Reason reason;
  const bool is_interface = hal::linux_host::parse_bus_name(bus.c_str(), name, reason) &&
                            name.kind == hal::linux_host::BusKind::kInterface;
  if (asked_for && !is_interface) {
    throw std::runtime_error("--vm: " + bus + " is no CAN interface; accepted is a name such as vcan0");
  }
  if (asked_for || !is_interface || kernel_has_can()) return asked_for;
  std::cout << "this system's kernel has no CAN: " << bus << " of a virtual machine it is" << std::endl;
  return true;
}

std::vector<std::string> arguments_of(const CLI::App& command, const CLI::Option* left_out) {
  std::vector<std::string> arguments{command.get_name()};
  for (const CLI::Option* option : command.get_options()) {
    if (option == left_out || option->count() == 0) continue;
    for (const std::string& value : option->results()) {
      arguments.push_back("--" + option->get_lnames().front() + "=" + value);
    }
  }
  return arguments;
}

void show_machine(const fs::path& log, const std::string& memory, const processes::TwinOf& of) {
  fs::remove(log);
  std::cout.flush();
  const pid_t machine = getpid();
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error(std::string("fork: ") + std::strerror(errno));
  if (child != 0) return;
  int code = 0;
  try {
    const std::atomic<bool>& stop = processes::stop_on_signals();
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    processes::BoardTwin twin(memory, of, std::cout);
    processes::LogFollower follower(log);
    while (!stop && getppid() == machine && twin.tells()) {
      if (!follower.look([&twin](const std::vector<wire::Frame>& frames) { twin.hear(frames); }))
        usleep(kLook_us);
    }
  } catch (const std::exception& error) {
    std::cerr << "the machine's ECU is not shown: " << error.what() << std::endl;
    code = 2;
  }
  _exit(code);
}

void run_in_machine(const std::string& bus, const std::vector<std::string>& arguments,
                    const std::vector<fs::path>& writable) {
  // The launcher of the sources installs what is missing first; an installed script says what is.
  std::vector<std::string> words{processes::own_data("vcan_machine.sh")};
  if (processes::has_own_data("source")) words = {processes::own_data("source") / "s4tp", "machine"};
  words.insert(words.end(), {"--seconds", kSeconds, "--interface", bus});
  for (const fs::path& folder : writable) {
    if (fs::is_directory(folder)) words.insert(words.end(), {"--writable", folder.string()});
  }
  words.push_back(fs::read_symlink("/proc/self/exe").string());
  words.insert(words.end(), arguments.begin(), arguments.end());
  processes::become(std::move(words));
}

}  // namespace s4tp::commands
