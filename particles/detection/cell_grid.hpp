#pragma once
// Spatial search: grains sorted into square cells, visited in a fixed order.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "particles/bodies/bodies.hpp"

namespace drumlin::particles {

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

/// What a search needs of a grain, in one place.
struct NearGrain {
  double x = 0, z = 0, radius = 0, v_x = 0, v_z = 0;
  std::int32_t body = 0;
};

/// Cells of at least the asked size; rebuilt every step in linear time.
class CellGrid {
 public:
  /// Takes the grains listed in `members`; v_x and v_z are the velocities that the search shall see.
  void sort(const Bodies& bodies, std::span<const double> v_x, std::span<const double> v_z,
            std::span<const std::int32_t> members, double cell_size, const Period& period);

  /// Calls `visit(grain)` for every grain in the cells that touch the rectangle, each once, in a fixed order.
  template <class Visit>
  void near(double x_low, double x_high, double z_low, double z_high, Visit visit) const {
    const int first_row = std::max(0, cell(z_low, origin_z_, cell_z_));
    const int last_row = std::min(rows_ - 1, cell(z_high, origin_z_, cell_z_));
    int first_column = cell(x_low, origin_x_, cell_x_);
    int last_column = cell(x_high, origin_x_, cell_x_);
    if (period_.open()) {
      first_column = std::max(0, first_column);
      last_column = std::min(columns_ - 1, last_column);
    } else if (last_column - first_column + 1 > columns_) {
      last_column = first_column + columns_ - 1;
    }
    for (int row = first_row; row <= last_row; ++row)
      for (int column = first_column; column <= last_column; ++column) {
        const int wrapped = period_.open() ? column : ((column % columns_) + columns_) % columns_;
        for (std::int32_t k = begin(row, wrapped); k < end(row, wrapped); ++k) visit(grains_[k]);
      }
  }

  /// Calls `visit(a, b)` once for every two grains in the same or in touching cells.
  template <class Visit>
  void each_pair(Visit visit) const {
    const bool narrow = !period_.open() && columns_ < 3;  // a cell is then its neighbour's neighbour too
    for (int row = 0; row < rows_; ++row)
      for (int column = 0; column < columns_; ++column)
        for (std::int32_t a = begin(row, column); a < end(row, column); ++a) {
          const auto meet = [&](std::int32_t from, std::int32_t to) {
            for (std::int32_t b = from; b < to; ++b) visit(grains_[a], grains_[b]);
          };
          if (narrow) {
            meet(a + 1, end(row, columns_ - 1));
            if (row + 1 < rows_) meet(begin(row + 1, 0), end(row + 1, columns_ - 1));
          } else if (period_.open()) {  // cells side by side are one stretch of grains
            meet(a + 1, end(row, std::min(column + 1, columns_ - 1)));
            if (row + 1 < rows_)
              meet(begin(row + 1, std::max(column - 1, 0)), end(row + 1, std::min(column + 1, columns_ - 1)));
          } else {
            const int right = (column + 1) % columns_, left = (column + columns_ - 1) % columns_;
            meet(a + 1, end(row, column));
            meet(begin(row, right), end(row, right));
            if (row + 1 < rows_)
              for (const int c : {left, column, right}) meet(begin(row + 1, c), end(row + 1, c));
          }
        }
  }

  std::span<const NearGrain> grains() const { return grains_; }

 private:
  static int cell(double x, double origin, double size) {
    return static_cast<int>(std::clamp(std::floor((x - origin) / size), -1e9, 1e9));
  }
  std::int32_t begin(int row, int column) const { return start_[row * columns_ + column]; }
  std::int32_t end(int row, int column) const { return start_[row * columns_ + column + 1]; }

  Period period_;
  std::vector<std::int32_t> cell_of_, start_, next_;
  std::vector<NearGrain> grains_;  // cell by cell, row by row
  int columns_ = 0, rows_ = 0;
  double origin_x_ = 0, origin_z_ = 0, cell_x_ = 1, cell_z_ = 1;
};

/// One grid per octave of sizes: a large grain does not fill its cell with hundreds of small ones.
class GrainGrids {
 public:
  /// Prepares searches for pairs of grains whose surfaces are at most `range` apart.
  void sort(const Bodies& bodies, std::span<const double> v_x, std::span<const double> v_z, double range,
            const Period& period);

  /// Calls `visit(grain)` for every grain whose centre is in the rectangle, and for some around it.
  template <class Visit>
  void near(double x_low, double x_high, double z_low, double z_high, Visit visit) const {
    for (std::size_t level = 0; level < used_; ++level)
      grids_[level].near(x_low, x_high, z_low, z_high, visit);
  }

  /// Calls `visit(a, b)` once for every two grains that may be within range.
  template <class Visit>
  void each_pair(Visit visit) const {
    for (std::size_t level = 0; level < used_; ++level) {
      grids_[level].each_pair(visit);
      for (std::size_t larger = 0; larger < level; ++larger)
        for (const NearGrain& a : grids_[level].grains()) {
          const double reach = a.radius + largest_[larger] / 2 + range_;
          grids_[larger].near(a.x - reach, a.x + reach, a.z - reach, a.z + reach,
                              [&](const NearGrain& b) { visit(a, b); });
        }
    }
  }

 private:
  std::vector<CellGrid> grids_;  // the largest grains first; those without grains are left out
  std::size_t used_ = 0;
  std::vector<double> largest_;  // diameter in each grid
  std::vector<std::vector<std::int32_t>> members_;
  double range_ = 0;
};

}  // namespace drumlin::particles
