#pragma once
/// Rows of a matrix, one behind the other. Internal: for algo/satp's own sources.

namespace s4tp::satp {

template <typename T>
struct Rows {
  T* data;
  int stride;  ///< elements from one row to the next

  [[nodiscard]] T* operator[](int index) const { return data + index * stride; }
};

}  // namespace s4tp::satp
