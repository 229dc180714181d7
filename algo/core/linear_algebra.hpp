#pragma once
/// Eigen as the core uses it: float, fixed sizes, nothing on the heap, its assertions ours; flags.cmake sets
/// the rest. Internal, as inline.hpp: an installed header would bind users to its version and alignment.

#include "algo/core/check.hpp"

// Unrolled by Eigen, a small product is many calls of one tiny function: the compiler by itself inlines none.
#define EIGEN_STRONG_INLINE __attribute__((always_inline)) inline
#define eigen_assert(condition) S4TP_ASSERT(condition)
#include <Eigen/Core>
#include <Eigen/LU>

namespace s4tp {

static_assert(EIGEN_WORLD_VERSION == 3 && EIGEN_MAJOR_VERSION == 4,
              "bits are promised for Eigen 3.4, whose order of additions they show");

template <int Rows>
using Vector = Eigen::Matrix<float, Rows, 1>;
template <int Rows, int Columns>
using Matrix = Eigen::Matrix<float, Rows, Columns>;

}  // namespace s4tp
