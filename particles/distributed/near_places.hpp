#pragma once
// Which places lie near some discs: marks on a raster that is the same on all ranks.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "particles/bodies/bodies.hpp"
#include "particles/bodies/walls.hpp"

namespace drumlin::particles {

/// Places within `reach` of `centre`.
struct Surroundings {
  Point centre;
  double reach = 0;
};

/// The square that holds all grains of a run, and how many these are.
struct GrainSquare {
  Point low;  ///< its lower left corner
  double edge = 1;
  std::size_t grains = 0;
};

/// Marks the squares of a raster that such places touch, where a rank has bodies. Whether a body's square is
/// marked does not depend on the rank.
class NearPlaces {
 public:
  /// Nothing marked. Squares are 1 d wide, or wider where there would be many more than grains in all.
  void clear(const GrainSquare& all, const Bodies& seen) {
    double width = 1;
    const double most = 16.0 * static_cast<double>(all.grains) + 1e5;
    while ((all.edge / width) * (all.edge / width) > most) width *= 2;
    low_ = all.low, per_length_ = 1 / width;
    columns_ = range_of(seen.x, low_.x), rows_ = range_of(seen.z, low_.z);
    marked_.assign(static_cast<std::size_t>(columns_.count()) * rows_.count(), 0);
  }
  void mark(std::span<const Surroundings> places) {
    for (const Surroundings& around : places) {
      const double x = (around.centre.x - low_.x) * per_length_, z = (around.centre.z - low_.z) * per_length_;
      const double reach = around.reach * per_length_;
      const Range rows = rows_.within(z - reach, z + reach);
      for (std::int64_t row = rows.first; row < rows.end; ++row) {
        const double away = std::max({0.0, static_cast<double>(row) - z, z - static_cast<double>(row) - 1});
        const double half = std::sqrt(std::max(0.0, reach * reach - away * away));
        const Range columns = columns_.within(x - half, x + half);
        if (columns.count() > 0) std::fill_n(marked_.begin() + place(columns.first, row), columns.count(), 1);
      }
    }
  }
  /// Of the place of a body that the rank sees.
  bool marked(Point p) const {
    return marked_[place(square((p.x - low_.x) * per_length_), square((p.z - low_.z) * per_length_))] != 0;
  }

 private:
  /// Numbers of squares along an axis.
  struct Range {
    std::int64_t first = 0, end = 0;
    std::int64_t count() const { return std::max<std::int64_t>(0, end - first); }
    Range within(double low, double high) const {
      return {std::max(first, square(low)), std::min(end, square(high) + 1)};
    }
  };

  static std::int64_t square(double along) { return static_cast<std::int64_t>(std::floor(along)); }
  Range range_of(std::span<const double> positions, double low) const {
    if (positions.empty()) return {};
    const auto [least, most] = std::minmax_element(positions.begin(), positions.end());
    return {square((*least - low) * per_length_), square((*most - low) * per_length_) + 1};
  }
  std::ptrdiff_t place(std::int64_t column, std::int64_t row) const {
    return (row - rows_.first) * columns_.count() + column - columns_.first;
  }

  Point low_;
  double per_length_ = 1;  // squares
  Range columns_, rows_;   // of the bodies that the rank sees
  std::vector<char> marked_;
};

}  // namespace drumlin::particles
