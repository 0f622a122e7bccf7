#pragma once
// Which places lie near some discs: a raster of marks, the same on all ranks.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "particles/bodies/walls.hpp"

namespace drumlin::particles {

/// Places within `reach` of `centre`.
struct Surroundings {
  Point centre;
  double reach = 0;
};

/// Marks the squares of a raster that such places touch.
class NearPlaces {
 public:
  /// A raster of the square from `low` of edge `edge`, nothing marked. Its squares are 1 d wide, or wider
  /// where there would be many more than `grains`.
  void clear(Point low, double edge, std::size_t grains) {
    low_ = low;
    double width = 1;
    const double most = 16.0 * static_cast<double>(grains) + 1e5;
    while ((edge / width) * (edge / width) > most) width *= 2;
    side_ = static_cast<std::int32_t>(edge / width) + 1;
    per_length_ = 1 / width;
    marked_.assign(static_cast<std::size_t>(side_) * side_, 0);
  }
  void mark(std::span<const Surroundings> places) {
    for (const Surroundings& around : places) {
      const double x = (around.centre.x - low_.x) * per_length_, z = (around.centre.z - low_.z) * per_length_;
      const double reach = around.reach * per_length_;
      for (std::int32_t row = place(z - reach); row <= place(z + reach); ++row) {
        const double away = std::max({0.0, row - z, z - row - 1});
        const double half = std::sqrt(std::max(0.0, reach * reach - away * away));
        auto* const squares = marked_.data() + static_cast<std::size_t>(row) * side_;
        std::fill(squares + place(x - half), squares + place(x + half) + 1, 1);
      }
    }
  }
  /// Whether the square of a place is marked; places outside count to the nearest.
  bool marked(Point p) const {
    return marked_[static_cast<std::size_t>(place((p.z - low_.z) * per_length_)) * side_ +
                   place((p.x - low_.x) * per_length_)] != 0;
  }

 private:
  std::int32_t place(double along) const {
    return static_cast<std::int32_t>(std::clamp(along, 0.0, side_ - 1.0));
  }

  Point low_;
  double per_length_ = 1;  // squares
  std::int32_t side_ = 1;  // squares along x and z
  std::vector<char> marked_;
};

}  // namespace drumlin::particles
