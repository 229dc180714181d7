#pragma once
/// A command of this tool, carried out in the virtual machine (toolchain/vcan_machine.sh), whose kernel has
/// CAN.

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "sim_host/processes/board_twin.hpp"

namespace s4tp::commands {

/// PROC-030 A CAN interface is one of the machine when that is asked for, and, told in a line, where this
/// system's kernel has no CAN. \throws std::runtime_error when it is asked for and the bus is no interface
[[nodiscard]] bool needs_machine(const std::string& bus, bool asked_for);

/// What `command` was given, option by option, except `left_out`.
[[nodiscard]] std::vector<std::string> arguments_of(const CLI::App& command, const CLI::Option* left_out);

/// PROC-032 A process of its own shows the ECU of the machine (processes/board_twin.hpp) by the log of its bus,
/// which run_in_machine() is to write; it ends when this process, or what takes its place, does.
/// \param log  removed first  \param memory  as BoardTwin
void show_machine(const std::filesystem::path& log, const std::string& memory, const processes::TwinOf& of);

/// PROC-031 This program with these arguments on a vcan named `bus`, instead of going on here: output, exit
/// code and what it writes into the `writable` folders that exist are those of the run there.
/// \throws std::runtime_error when it cannot be started
[[noreturn]] void run_in_machine(const std::string& bus, const std::vector<std::string>& arguments,
                                 const std::vector<std::filesystem::path>& writable);

}  // namespace s4tp::commands
