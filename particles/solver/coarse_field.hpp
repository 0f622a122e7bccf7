#pragma once
// The smooth field that scales the impulses of a large packing (particles/solver/coarse_loads.hpp): its
// nodes, where bodies stand among them, and the solve for it. In one process and on ranks alike.
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace drumlin::particles {

/// Where a body is: the lowest and leftmost of the four nodes around it, the node next to it, and how far to
/// the right of the first and above it, in edges.
struct NodePlace {
  std::int16_t column = 0, row = 0, next_column = 0, next_row = 0;
  double right = 0, up = 0;
  /// Of the four nodes, the lower ones first.
  std::array<double, 4> weights() const {
    return {(1 - right) * (1 - up), right * (1 - up), (1 - right) * up, right * up};
  }
};

/// Nodes of a field at the corners of square cells, row by row.
struct FieldGrid {
  double x = 0, z = 0, edge = 1;
  int columns = 2, rows = 2;

  int nodes() const { return columns * rows; }
  int index(int column, int row) const { return row * columns + column; }
  /// One of the four nodes around a body, and one of the nine next to it.
  int corner(const NodePlace& at, int k) const { return index(at.column + k % 2, at.row + k / 2); }
  int neighbour(const NodePlace& at, int k) const {
    return index(at.next_column + k % 3 - 1, at.next_row + k / 3 - 1);
  }
  NodePlace place_at(double place_x, double place_z) const;
};

/// Least and largest places of bodies.
struct FieldExtent {
  double x_low = 0, x_high = 0, z_low = 0, z_high = 0;
};
/// The nodes over the bodies of a problem; `longest`: the largest distance of the bodies of a contact along x
/// or z.
FieldGrid field_grid(const FieldExtent& extent, std::int64_t contacts, double longest);

/// Of a row of the matrix, which is symmetric: the entries of the node itself and of those after it, up to
/// two columns and rows away.
inline constexpr int entries_of_node = 13;
/// Solves for the field: `rows` has these entries of each node, `right` its right side. Empty where the
/// matrix or the result is no good.
std::vector<double> solve_field(const FieldGrid& grid, std::span<const double> rows,
                                std::span<const double> right);
/// What the field makes of an impulse there: a factor between 1/2 and 2.
double factor_at(const FieldGrid& grid, const NodePlace& at, std::span<const double> field);

/// What the impulses, weighted by the hat of a node, do to the velocities of a body: x, z, s, and 0.
struct alignas(16) NodeMove {
  std::array<float, 4> entries{};
};
/// Of the node next to the body and the eight around that.
using NodeMoves = std::array<NodeMove, 9>;

}  // namespace drumlin::particles
