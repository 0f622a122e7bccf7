#pragma once
// Grains sorted into square cells: who is near a place, in a fixed order.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "particles/bodies/bodies.hpp"

namespace drumlin {

/// Period of the domain in x; length 0: open.
struct Period {
  double origin = 0;
  double length = 0;
  bool open() const { return length <= 0; }
  /// The nearest image of a difference.
  double nearest(double dx) const { return open() ? dx : dx - length * std::round(dx / length); }
  /// The image in the first period.
  double first(double x) const { return open() ? x : x - length * std::floor((x - origin) / length); }
};

/// Cells of at least the asked size; rebuilt every step in linear time.
class CellGrid {
 public:
  void sort(const Bodies& bodies, double cell_size, const Period& period);

  /// Calls `visit(grain)` for every grain in the cells that touch the rectangle, each once, in a fixed order.
  template <class Visit>
  void near(double x_low, double x_high, double z_low, double z_high, Visit visit) const {
    const int first_row = std::max(0, cell(z_low, origin_z_, cell_z_));
    const int last_row = std::min(rows_ - 1, cell(z_high, origin_z_, cell_z_));
    int first_column = cell(x_low, period_.open() ? origin_x_ : period_.origin, cell_x_);
    int last_column = cell(x_high, period_.open() ? origin_x_ : period_.origin, cell_x_);
    if (period_.open()) {
      first_column = std::max(0, first_column);
      last_column = std::min(columns_ - 1, last_column);
    } else if (last_column - first_column + 1 > columns_) {
      last_column = first_column + columns_ - 1;
    }
    for (int row = first_row; row <= last_row; ++row)
      for (int column = first_column; column <= last_column; ++column) {
        const int wrapped = period_.open() ? column : ((column % columns_) + columns_) % columns_;
        const std::size_t c = static_cast<std::size_t>(row) * columns_ + wrapped;
        for (std::int32_t k = start_[c]; k < start_[c + 1]; ++k) visit(grains_[k]);
      }
  }

 private:
  static int cell(double x, double origin, double size) {
    return static_cast<int>(std::clamp(std::floor((x - origin) / size), -1e9, 1e9));
  }

  Period period_;
  std::vector<std::int32_t> cell_of_, start_, next_, grains_;
  int columns_ = 0, rows_ = 0;
  double origin_x_ = 0, origin_z_ = 0, cell_x_ = 1, cell_z_ = 1;
};

}  // namespace drumlin
