#include "algo/core/status.hpp"

namespace s4tp {

const char* status_name(Status status) {
  switch (status) {
    case Status::kOk:
      return "kOk";
    case Status::kNotInitialized:
      return "kNotInitialized";
    case Status::kInvalidParameter:
      return "kInvalidParameter";
    case Status::kArithmetic:
      return "kArithmetic";
    case Status::kInvalidInput:
      return "kInvalidInput";
    case Status::kNoLane:
      return "kNoLane";
    case Status::kNoSafePlan:
      return "kNoSafePlan";
    case Status::kStaleTracks:
      return "kStaleTracks";
  }
  return "unknown";
}

}  // namespace s4tp
