// deal.II's own search goes through all cells for a point that lies on another rank.
#include <deal.II/base/bounding_box.h>
#include <deal.II/fe/mapping.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "continuum/fem/detail/discretisation.hpp"

namespace drumlin::continuum::fem {
namespace {

using Cell = dealii::DoFHandler<2>::active_cell_iterator;

// Squares of a regular grid, each with the cells whose box touches it.
class CellGrid {
 public:
  explicit CellGrid(const Discretisation& d) {
    dealii::Point<2> low(1e300, 1e300), high(-1e300, -1e300);
    double size = 0;
    for (const Cell& cell : d.unknowns.active_cell_iterators())
      if (cell->is_locally_owned()) {
        cells_.push_back(cell);
        boxes_.push_back(box_of(d, cell));
        for (int i = 0; i < 2; ++i) {
          low[i] = std::min(low[i], boxes_.back().first[i]);
          high[i] = std::max(high[i], boxes_.back().second[i]);
        }
        size += cell->diameter();
      }
    if (cells_.empty()) return;
    origin_ = low;
    square_ = size / static_cast<double>(cells_.size());
    columns_ = 1 + static_cast<long>((high[0] - low[0]) / square_);
    rows_ = 1 + static_cast<long>((high[1] - low[1]) / square_);
    squares_.resize(static_cast<std::size_t>(columns_ * rows_));
    for (std::size_t c = 0; c < cells_.size(); ++c) {
      const auto [from, to] = boxes_[c];
      for (long row = index(from[1], 1); row <= index(to[1], 1); ++row)
        for (long column = index(from[0], 0); column <= index(to[0], 0); ++column)
          squares_[static_cast<std::size_t>(row * columns_ + column)].push_back(c);
    }
  }

  template <class Accept>
  void for_candidates(const dealii::Point<2>& p, Accept accept) const {
    if (cells_.empty()) return;
    const long column = index(p[0], 0), row = index(p[1], 1);
    if (column < 0 || column >= columns_ || row < 0 || row >= rows_) return;
    for (const std::size_t c : squares_[static_cast<std::size_t>(row * columns_ + column)]) {
      const auto& [from, to] = boxes_[c];
      if (p[0] >= from[0] && p[0] <= to[0] && p[1] >= from[1] && p[1] <= to[1] && accept(cells_[c])) return;
    }
  }

 private:
  using Box = std::pair<dealii::Point<2>, dealii::Point<2>>;
  // Sides of a quadratic cell bulge beyond its corners.
  static Box box_of(const Discretisation& d, const Cell& cell) {
    const auto box = d.mapping.get_bounding_box(cell).get_boundary_points();
    const double margin = 0.2 * cell->diameter();
    const dealii::Tensor<1, 2> wider({margin, margin});
    return {box.first - wider, box.second + wider};
  }
  long index(double coordinate, int axis) const {
    return static_cast<long>(std::floor((coordinate - origin_[axis]) / square_));
  }

  std::vector<Cell> cells_;
  std::vector<Box> boxes_;
  dealii::Point<2> origin_;
  double square_ = 1;
  long columns_ = 0, rows_ = 0;
  std::vector<std::vector<std::size_t>> squares_;
};

}  // namespace

std::vector<CellPlaces> locate(const Discretisation& d, std::span<const Vec2> points) {
  const CellGrid grid(d);
  std::map<Cell, std::vector<PlaceOnMesh>> found;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const dealii::Point<2> p(points[k].x, points[k].z);
    grid.for_candidates(p, [&](const Cell& cell) {
      try {
        const auto unit = d.mapping.transform_real_to_unit_cell(cell, p);
        if (!dealii::GeometryInfo<2>::is_inside_unit_cell(unit, 1e-9)) return false;
        found[cell].push_back({k, dealii::GeometryInfo<2>::project_to_unit_cell(unit)});
        return true;
      } catch (const dealii::Mapping<2>::ExcTransformationFailed&) {
        return false;  // far outside of a curved cell
      }
    });
  }
  std::vector<CellPlaces> result;
  result.reserve(found.size());
  for (auto& [cell, places] : found) result.push_back({cell, std::move(places)});
  return result;
}

}  // namespace drumlin::continuum::fem
