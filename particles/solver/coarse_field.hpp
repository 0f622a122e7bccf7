#pragma once
// The smooth field that scales the impulses of a large packing (particles/solver/coarse_loads.hpp): its
// nodes, where bodies stand among them, and the solve for it.
#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace drumlin::particles {

/// Nodes of a field at the corners of square cells, row by row.
struct FieldGrid {
  double x = 0, z = 0, edge = 1;
  int columns = 2, rows = 2;

  int nodes() const { return columns * rows; }
  int index(int column, int row) const { return row * columns + column; }
  /// Column and row of the cell of a position in edges from the first node, which is not outside; the cell
  /// goes by its lower left node.
  int column_at(double from_left) const { return std::min(static_cast<int>(from_left), columns - 2); }
  int row_at(double from_below) const { return std::min(static_cast<int>(from_below), rows - 2); }
  int cell_at(double from_left, double from_below) const {
    return index(column_at(from_left), row_at(from_below));
  }
  /// A corner of the cell: from left to right and then up.
  int corner(int cell, int k) const { return cell + k % 2 + columns * (k / 2); }
};

/// Least and largest positions of bodies.
struct FieldExtent {
  double x_low = 0, x_high = 0, z_low = 0, z_high = 0;
};
/// The nodes over the bodies of a problem; `longest`: the largest distance of the bodies of a contact along x
/// or z.
FieldGrid field_grid(const FieldExtent& extent, std::int64_t contacts, double longest);

/// Of a row of the matrix, which is symmetric: the entries of the node itself, of the one to the right of it,
/// and of the three above.
inline constexpr int entries_of_node = 5;
/// Solves for the field: `rows` has these entries of each node, `right` its right side. Empty where the
/// matrix or the result is no good.
std::vector<double> solve_field(const FieldGrid& grid, std::span<const double> rows,
                                std::span<const double> right);
/// What the field makes of an impulse there, in edges from the first node: a factor between 1/2 and 2.
double factor_at(const FieldGrid& grid, double from_left, double from_below, std::span<const double> field);

}  // namespace drumlin::particles
