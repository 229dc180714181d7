#pragma once
/// Containers with a compile-time capacity: they never allocate and never throw.

#include <cstddef>

#include "algo/core/check.hpp"

namespace s4tp {

/// Up to N values in order. The storage is part of the object; elements beyond size() keep stale values.
template <typename T, int N>
class BoundedVector {
 public:
  static constexpr int kCapacity = N;

  [[nodiscard]] int size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] bool full() const { return size_ == N; }
  void clear() { size_ = 0; }

  /// \return false, with nothing changed, when the container is full
  [[nodiscard]] bool push(const T& value) {
    if (full()) return false;
    items_[size_++] = value;
    return true;
  }

  /// Shortens to `size` elements. \pre 0 <= size <= size()
  void truncate(int size) {
    S4TP_ASSERT(size >= 0 && size <= size_);
    size_ = size;
  }

  /// Removes element `index` by moving the last one into its place. \pre 0 <= index < size()
  void swap_remove(int index) {
    S4TP_ASSERT(index >= 0 && index < size_);
    items_[index] = items_[--size_];
  }

  [[nodiscard]] T& operator[](int index) {
    S4TP_ASSERT(index >= 0 && index < size_);
    return items_[index];
  }
  [[nodiscard]] const T& operator[](int index) const {
    S4TP_ASSERT(index >= 0 && index < size_);
    return items_[index];
  }

  [[nodiscard]] T* begin() { return items_; }
  [[nodiscard]] T* end() { return items_ + size_; }
  [[nodiscard]] const T* begin() const { return items_; }
  [[nodiscard]] const T* end() const { return items_ + size_; }

 private:
  T items_[N] = {};
  int size_ = 0;
};

}  // namespace s4tp
