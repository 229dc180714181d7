#include "sim_host/processes/emulated_board.hpp"

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "sim_host/world/scenario/listed.hpp"

namespace s4tp::processes {
namespace {

constexpr EmulatedBoard kBoards[] = {{"m7", "mps2-an500", 1.6, "0x64000"},
                                     {"m55", "mps3-an547", 2.048, "0x1024000"}};

/// A path inside one of QEMU's options, where a comma ends a value.
std::string quoted(const std::filesystem::path& path) {
  std::string result;
  for (const char c : path.string()) result += c == ',' ? ",," : std::string(1, c);
  return result;
}

}  // namespace

const EmulatedBoard& find_board(const std::string& target) {
  for (const EmulatedBoard& board : kBoards) {
    if (target == board.target) return board;
  }
  throw std::invalid_argument("target '" + target + "': there are " +
                              scenario::listed(kBoards, &EmulatedBoard::target));
}

std::vector<std::string> board_targets() {
  std::vector<std::string> targets;
  for (const EmulatedBoard& board : kBoards) targets.emplace_back(board.target);
  return targets;
}

std::uint16_t free_loopback_port() {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  const int probe = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const bool found = probe >= 0 && bind(probe, reinterpret_cast<sockaddr*>(&address), size) == 0 &&
                     getsockname(probe, reinterpret_cast<sockaddr*>(&address), &size) == 0;
  const int error = errno;
  if (probe >= 0) close(probe);
  if (!found) throw std::runtime_error(std::string("no free port on 127.0.0.1: ") + std::strerror(error));
  return ntohs(address.sin_port);
}

std::vector<std::string> board_command(const EmulatedBoard& board, const std::filesystem::path& image,
                                       std::uint16_t port, const std::filesystem::path& console,
                                       const std::filesystem::path& weights) {
  std::vector<std::string> command{"qemu-system-arm",
                                   "-M",
                                   board.machine,
                                   "-display",
                                   "none",
                                   "-monitor",
                                   "none",
                                   "-no-reboot",
                                   "-icount",
                                   "shift=6",
                                   "-chardev",
                                   "file,id=console,path=" + quoted(console),
                                   "-serial",
                                   "chardev:console",
                                   "-chardev",
                                   "socket,id=can,host=127.0.0.1,nodelay=on,port=" + std::to_string(port),
                                   "-serial",
                                   "chardev:can",
                                   "-kernel",
                                   image.string()};
  if (!weights.empty()) {
    command.insert(command.end(), {"-device", "loader,force-raw=on,addr=" + std::string(board.weights_bank) +
                                                  ",file=" + quoted(std::filesystem::absolute(weights))});
  }
  return command;
}

}  // namespace s4tp::processes
