#pragma once
/// Gives lists of lies the digest that a sender who lies would give them.

#include <vector>

#include "firmware/wire/frame.hpp"

namespace s4tp::faults {

class ListSealer {
 public:
  /// FAULT-004 While `lying`, a track list is held until all its members have passed, then goes on with the
  /// digest of what they say now; what never becomes whole goes on as it is when the next header comes or the
  /// lies are over.
  void pass(bool lying, std::vector<wire::Frame>& frames);

 private:
  void release(std::vector<wire::Frame>& frames);

  std::vector<wire::Frame> held_;
};

}  // namespace s4tp::faults
