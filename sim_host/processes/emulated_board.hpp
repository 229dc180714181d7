#pragma once
/// QEMU as the ECU's hardware: which board a target is, and how to start one. Instructions take 64 ns each,
/// so that the board's timers count them.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace s4tp::processes {

struct EmulatedBoard {
  const char* target;
  const char* machine;            ///< QEMU's name
  double counts_per_instruction;  ///< SysTick's, at 64 ns an instruction: 25 MHz and 32 MHz
  const char* weights_bank;       ///< where the second half of WEIGHTS begins (toolchain/linker)
};

/// \throws std::invalid_argument naming the targets there are
[[nodiscard]] const EmulatedBoard& find_board(const std::string& target);
[[nodiscard]] std::vector<std::string> board_targets();

/// A port of 127.0.0.1 that nobody listens on. \throws std::runtime_error
[[nodiscard]] std::uint16_t free_loopback_port();

/// QEMU with the CAN line as a TCP connection to `port` and the console in a file. A board that is reset ends
/// instead of starting again: the watchdog has bitten. \param weights  image in the bank for weights, or empty
[[nodiscard]] std::vector<std::string> board_command(const EmulatedBoard& board,
                                                     const std::filesystem::path& image, std::uint16_t port,
                                                     const std::filesystem::path& console,
                                                     const std::filesystem::path& weights = {});

}  // namespace s4tp::processes
