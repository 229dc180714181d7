#pragma once
/// A table of transitions, as data: nothing but its rows changes a state.

namespace s4tp::behavior {

template <class State, class Situation>
struct Transition {
  State from;
  bool (*condition)(const Situation& situation);
  State to;
};

/// The state after one cycle: that of the first row that applies, else the same.
template <class State, class Situation, int kRows>
[[nodiscard]] State next_state(const Transition<State, Situation> (&table)[kRows], State from,
                               const Situation& situation) {
  for (const Transition<State, Situation>& row : table) {
    if (row.from == from && row.condition(situation)) return row.to;
  }
  return from;
}

}  // namespace s4tp::behavior
