#include "algo/scene/conflict_view.hpp"

#include "algo/core/inline.hpp"

namespace s4tp::scene {
namespace {

bool in_range(LaneIndex index) {
  return index >= 0 && index < kMaxLanes;
}

Priority seen_from_second(Priority priority) {
  switch (priority) {
    case Priority::kFirstYields:
      return Priority::kFirstHasPriority;
    case Priority::kFirstHasPriority:
      return Priority::kFirstYields;
    case Priority::kFirstCome:
      break;
  }
  return Priority::kFirstCome;
}

}  // namespace

bool sound(const Conflict& conflict) {
  constexpr float kLongestM = 1e5F;
  // Written so that NaN fails.
  return in_range(conflict.first) && in_range(conflict.second) && conflict.first != conflict.second &&
         conflict.first_entry_m > -kLongestM && conflict.first_entry_m <= conflict.first_exit_m &&
         conflict.first_exit_m < kLongestM && conflict.second_entry_m > -kLongestM &&
         conflict.second_entry_m <= conflict.second_exit_m && conflict.second_exit_m < kLongestM;
}

ConflictView view_from(const Conflict& conflict, bool from_second) {
  const Priority priority =
      conflict.priority == Priority::kFirstYields || conflict.priority == Priority::kFirstHasPriority
          ? conflict.priority
          : Priority::kFirstCome;
  if (from_second) {
    return {conflict.second,         conflict.first,         seen_from_second(priority),
            conflict.second_entry_m, conflict.second_exit_m, conflict.first_entry_m,
            conflict.first_exit_m};
  }
  return {conflict.first,         conflict.second,       priority,
          conflict.first_entry_m, conflict.first_exit_m, conflict.second_entry_m,
          conflict.second_exit_m};
}

}  // namespace s4tp::scene
