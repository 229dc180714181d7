#pragma once
/// Files made of a fuzzer's bytes, and the oracle for their readers: a result, or an error that a user can act upon.

#include <exception>
#include <stdexcept>
#include <string>

#include "tests/fuzz/input.hpp"
#include "tests/support/networks.hpp"

namespace s4tp::fuzz {

/// One folder a process; TMPDIR says where (memory is fastest).
inline const test::Folder& folder() {
  static const test::Folder own;
  return own;
}

/// \return false: it was refused, and the error names what was read. Anything but a std::runtime_error ends the process.
template <class Read>
bool accepts(const std::string& name, const Read& read) {
  try {
    read();
    return true;
  } catch (const std::runtime_error& error) {
    const std::string what = error.what();
    expect(what.find(name) != std::string::npos, "an error names the file");
    expect(what.size() > name.size() + 10, "an error says what is wrong");
    return false;
  }
}

}  // namespace s4tp::fuzz
