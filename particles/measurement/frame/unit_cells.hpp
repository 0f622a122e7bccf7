#pragma once
// Cells of 1 d side by side over a rectangle: which of them holds a place, and which stand around it.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "coupling/core/basics/bilinear.hpp"
#include "particles/measurement/frame/disc_area.hpp"

namespace drumlin::particles {

/// Cells are counted row after row from the lowest up.
struct UnitCells {
  /// `period` > 0: in place of the width of the rectangle, shared out evenly; columns follow each other
  /// round.
  explicit UnitCells(const Rectangle& over, double its_period = 0)
      : x_min(over.x_min),
        z_min(over.z_min),
        period(its_period),
        columns(cells_along(period > 0 ? period : over.x_max - over.x_min)),
        rows(cells_along(over.z_max - over.z_min)) {
    if (period > 0) width = period / columns;
  }

  /// In cells from the lower left corner on.
  std::array<double, 2> place(double x, double z) const {
    if (period > 0) x -= period * std::floor((x - x_min) / period);
    return {(x - x_min) / width, z - z_min};
  }
  /// The cell of column and row; none beyond the grid.
  std::optional<std::size_t> cell(double column, double row) const {
    if (period > 0) column -= columns * std::floor(column / columns);
    if (!(column >= 0 && column < columns && row >= 0 && row < rows)) return std::nullopt;
    return static_cast<std::size_t>(row * columns + column);
  }
  /// action(cell, weight) for those of the four cells with their middles around a place that are in the grid.
  template <class Action>
  void each_around(double x, double z, Action action) const {
    const auto [column, row] = place(x, z);
    each_corner(column - 0.5, row - 0.5, [&](double c, double r, double weight) {
      if (const auto found = cell(c, r)) action(*found, weight);
    });
  }
  std::size_t cells() const { return static_cast<std::size_t>(columns * rows); }

  double x_min, z_min, period, width = 1;
  double columns, rows;  ///< whole numbers

 private:
  static double cells_along(double length) { return std::max(1.0, std::ceil(length)); }
};

}  // namespace drumlin::particles
