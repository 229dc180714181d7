#pragma once
/// Order for the few values of a bounded list: sorted in place, equals as they came. Internal: what `before`
/// compares are floats, and an installed header has no templates that do (inline.hpp says why).
/// \param before  of two values, whether the first belongs before the second

#include "algo/core/bounded.hpp"

namespace s4tp {

/// Moves items[last] forward to its place among those before it, which are in order.
template <typename T, typename Before>
void move_to_place(T* items, int last, const Before& before) {
  const T moving = items[last];
  int place = last;
  for (; place > 0 && before(moving, items[place - 1]); --place) items[place] = items[place - 1];
  items[place] = moving;
}

template <typename T, int N, typename Before>
void sort(BoundedVector<T, N>& list, const Before& before) {
  for (int i = 1; i < list.size(); ++i) move_to_place(list.begin(), i, before);
}

/// Adds `item` to a list that is in order. The last one falls out of a full list, which may be the new one.
template <typename T, int N, typename Before>
void insert(BoundedVector<T, N>& list, const T& item, const Before& before) {
  if (list.full()) {
    if (!before(item, list[N - 1])) return;
    list.truncate(N - 1);
  }
  (void)list.push(item);
  move_to_place(list.begin(), list.size() - 1, before);
}

}  // namespace s4tp
