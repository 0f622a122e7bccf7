#pragma once
// Boxes in a binary tree: those around a point are found without a look at all of them.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "particles/bodies/walls.hpp"

namespace drumlin::particles {

class BoxTree {
 public:
  void plant(std::span<const Reaches> boxes) {
    const std::size_t count = count_ = boxes.size();
    nodes_.resize(2 * count);
    std::copy(boxes.begin(), boxes.end(), nodes_.begin() + count);
    for (std::size_t k = count; k-- > 1;) {
      const Reaches &a = nodes_[2 * k], &b = nodes_[2 * k + 1];
      nodes_[k] = {std::min(a.x_low, b.x_low), std::max(a.x_high, b.x_high), std::min(a.z_low, b.z_low),
                   std::max(a.z_high, b.z_high)};
    }
  }

  /// Calls visit(k) for every box k that is no further than `reach` from a point along both axes, in any
  /// order; returns the number of boxes that were looked at.
  template <class Visit>
  std::int64_t each_near(Point p, double reach, Visit visit) const {
    std::array<std::size_t, 8 * sizeof(std::size_t)> left;
    std::size_t open = 0;
    std::int64_t looked_at = 0;
    const auto look_at = [&](std::size_t k) {
      const Reaches& box = nodes_[k];
      ++looked_at;
      if (p.z >= box.z_low - reach && p.z <= box.z_high + reach && p.x >= box.x_low - reach &&
          p.x <= box.x_high + reach)
        left[open++] = k;
    };
    if (count_ > 0) look_at(1);
    while (open > 0) {
      const std::size_t k = left[--open];
      if (k >= count_)
        visit(k - count_);
      else
        look_at(2 * k), look_at(2 * k + 1);
    }
    return looked_at;
  }

 private:
  std::size_t count_ = 0;
  std::vector<Reaches> nodes_;  // of node k those of 2 k and 2 k + 1 are in it; the last half are the boxes
};

}  // namespace drumlin::particles
