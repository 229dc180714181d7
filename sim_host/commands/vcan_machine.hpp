#pragma once
/// A command of this tool, carried out in the virtual machine (toolchain/vcan_machine.sh), whose kernel has
/// CAN.

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

namespace s4tp::commands {

/// PROC-030 A CAN interface is one of the machine when that is asked for, and, told in a line, where this
/// system's kernel has no CAN. \throws std::runtime_error when it is asked for and the bus is no interface
[[nodiscard]] bool needs_machine(const std::string& bus, bool asked_for);

/// What `command` was given, option by option, except `left_out`.
[[nodiscard]] std::vector<std::string> arguments_of(const CLI::App& command, const CLI::Option* left_out);

/// PROC-031 This program with these arguments on a vcan named `bus`, instead of going on here: output, exit
/// code and what it writes into the `writable` folders that exist are those of the run there.
/// \throws std::runtime_error when it cannot be started
[[noreturn]] void run_in_machine(const std::string& bus, const std::vector<std::string>& arguments,
                                 const std::vector<std::filesystem::path>& writable);

}  // namespace s4tp::commands
