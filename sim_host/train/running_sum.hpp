#pragma once
/// Sums along a tensor that are the same to the bit each time.

#include <torch/types.h>

namespace s4tp::train {

/// \param x [R, N, ...] \return [R, N, ...] sum of the first 1, 2 .. N
inline torch::Tensor running_sum(const torch::Tensor& x) {
  if (!x.is_cuda()) return x.cumsum(1);
  // Torch does not vouch for the bits of its own there. A product with a triangle of ones has them.
  const auto count = x.size(1);
  const torch::Tensor rows = torch::ones({count, count}, x.options()).tril();
  return torch::matmul(rows, x.reshape({x.size(0), count, -1})).reshape(x.sizes());
}

}  // namespace s4tp::train
