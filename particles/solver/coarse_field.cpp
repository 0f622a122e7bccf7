#include "particles/solver/coarse_field.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>

namespace drumlin::particles {
namespace {

// Of a cell of a full packing: the field of 100,000 discs has some twelve cells along its longer side.
constexpr double contacts_per_cell = 1400;
// Added to the diagonal, in parts of it and of its largest entry: nodes without loads keep s = 0.
constexpr double damping = 1e-3, ground = 1e-10;
// Of a cell, at least, over the distance of the bodies of a contact, over which hats count as linear.
constexpr double edges_per_contact = 2;

}  // namespace

FieldGrid field_grid(const FieldExtent& extent, std::int64_t contacts, double longest) {
  const double width = extent.x_high - extent.x_low, height = extent.z_high - extent.z_low;
  const double cells =
      std::max(1.0, std::round(std::sqrt(static_cast<double>(contacts) / contacts_per_cell)));
  FieldGrid grid{extent.x_low, extent.z_low, std::max(width, height) / cells};
  grid.edge = std::max(grid.edge, edges_per_contact * longest);
  if (!(grid.edge > 0)) grid.edge = 1;
  grid.columns = std::max(1, static_cast<int>(std::ceil(width / grid.edge))) + 1;
  grid.rows = std::max(1, static_cast<int>(std::ceil(height / grid.edge))) + 1;
  return grid;
}

std::vector<double> solve_field(const FieldGrid& grid, std::span<const double> rows,
                                std::span<const double> right) {
  const int nodes = grid.nodes();
  double largest = 0;
  for (int k = 0; k < nodes; ++k) largest = std::max(largest, rows[entries_of_node * k]);
  if (!(largest > 0)) return {};
  std::vector<Eigen::Triplet<double>> entries;  // of the lower triangle
  for (int k = 0; k < nodes; ++k)
    for (int e = 0; e < entries_of_node; ++e) {
      constexpr std::array<int, entries_of_node> right_of{0, 1, -1, 0, 1}, above{0, 0, 1, 1, 1};
      const int column = k % grid.columns + right_of[e], row = k / grid.columns + above[e];
      if (column < 0 || column >= grid.columns || row >= grid.rows) continue;
      double value = rows[entries_of_node * k + e];
      if (e == 0) value += damping * value + ground * largest;
      if (value != 0) entries.emplace_back(grid.index(column, row), k, value);
    }
  Eigen::SparseMatrix<double> matrix(nodes, nodes);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(matrix);
  if (factors.info() != Eigen::Success) return {};
  const Eigen::VectorXd field = factors.solve(Eigen::Map<const Eigen::VectorXd>(right.data(), nodes));
  if (!field.allFinite()) return {};
  return {field.begin(), field.end()};
}

double factor_at(const FieldGrid& grid, double from_left, double from_below, std::span<const double> field) {
  const int column = grid.column_at(from_left), row = grid.row_at(from_below);
  const double right = from_left - column, up = from_below - row;
  const double* const below = &field[grid.index(column, row)];
  const double* const above = &field[grid.index(column, row + 1)];
  const double low = (1 - right) * below[0] + right * below[1];
  const double high = (1 - right) * above[0] + right * above[1];
  return std::clamp(1 + ((1 - up) * low + up * high), 0.5, 2.0);
}

}  // namespace drumlin::particles
