#pragma once
// Spatial search: grains sorted into square cells. Only cells that hold grains exist, so that a stray grain
// costs neither memory nor time, wherever it is.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "particles/bodies/bodies.hpp"
#include "particles/bodies/period.hpp"
#include "particles/parallel/parallel_loops.hpp"
#include "particles/parallel/work_memory.hpp"

namespace drumlin::particles {

/// What a search needs of a grain, in one place.
struct NearGrain {
  double x = 0, z = 0, radius = 0, v_x = 0, v_z = 0;
  std::int32_t body = 0;
  double sorted_x = 0, sorted_z = 0;  ///< where it was when it was sorted into its cell
};

/// The state that a search sees: positions and radii of the bodies, and velocities of its own.
struct SearchedState {
  const Bodies& bodies;
  std::span<const double> v_x, v_z;
  Period period;
};

/// Cells of at least the asked size, sorted by rows and, within a row, by columns.
class CellGrid {
 public:
  /// One cell; its grains end where those of the next one begin.
  struct Cell {
    std::int32_t row = 0, column = 0;
    std::int32_t first = 0;
  };

  /// Takes work space from a memory, in the scope that is open when grains are sorted.
  void use(WorkMemory* memory) { places_.use(memory), sorted_.use(memory); }
  /// Takes the grains listed in `members`, in linear time.
  void sort(const SearchedState& state, std::span<const std::int32_t> members, double cell_size);
  /// Gives the grains their positions and velocities of now; they stay in their cells. Of an open domain.
  /// False if one has another radius than it had.
  bool follow(const SearchedState& state, const ParallelLoops& loops);
  /// Bound on how far any grain has moved along x or z since it was sorted.
  double drift() const { return drift_; }

  std::span<const NearGrain> grains() const { return grains_; }
  /// The cells that hold grains; one more marks the end.
  std::span<const Cell> cells() const { return cells_; }
  std::size_t count() const { return cells_.size() - 1; }
  /// What it holds from one search to the next.
  std::size_t bytes() const {
    return grains_.capacity() * sizeof(NearGrain) + cells_.capacity() * sizeof(Cell) +
           rows_.capacity() * sizeof(Row);
  }

  /// Calls `visit(grain)` for every grain in the rectangle and for some around it, each once, in a fixed
  /// order.
  template <class Visit>
  void near(double x_low, double x_high, double z_low, double z_high, Visit visit) const {
    x_low -= drift_, x_high += drift_, z_low -= drift_, z_high += drift_;
    const int last_row = coordinate(z_high, origin_z_, cell_z_);
    int left = coordinate(x_low, origin_x_, cell_x_), right = coordinate(x_high, origin_x_, cell_x_);
    int again = 0;  // columns of the first period that a rectangle reaches beyond its end
    if (!period_.open()) {
      if (std::int64_t{right} - left + 1 >= columns_) {
        left = 0, right = columns_ - 1;
      } else {
        const int wrapped = ((left % columns_) + columns_) % columns_;
        right += wrapped - left, left = wrapped;
        again = std::max(0, right - columns_ + 1);
      }
    }
    for (std::size_t r = row_at(coordinate(z_low, origin_z_, cell_z_));
         r + 1 < rows_.size() && rows_[r].row <= last_row; ++r) {
      each_in(r, left, right, visit);
      if (again > 0) each_in(r, 0, again - 1, visit);
    }
  }

  /// Calls `meet(a, begin, end)` for the positions of grains such that, over all cells, every two grains in
  /// the same or in touching cells meet once: those of the cells [first, last) meet others.
  template <class Meet>
  void each_pair(std::size_t first, std::size_t last, Meet meet) const {
    if (first >= last) return;
    std::size_t r = row_of_cell(first);
    std::size_t below = 0;  // cell of the next row: the first that is not left of the touching ones
    bool entered = false;
    const bool narrow = !period_.open() && columns_ < 3;  // a cell is then its neighbour's neighbour too
    for (std::size_t c = first; c < last; ++c) {
      for (; rows_[r + 1].first <= static_cast<std::int32_t>(c); ++r) entered = false;
      const bool has_next = r + 2 < rows_.size() && rows_[r + 1].row == rows_[r].row + 1;
      if (!entered) below = has_next ? rows_[r + 1].first : 0;
      entered = true;
      const Cell& cell = cells_[c];
      const auto meets = [&](std::size_t from, std::size_t to) {  // cells
        if (from < to)
          for (std::int32_t a = cell.first; a < cells_[c + 1].first; ++a)
            meet(a, cells_[from].first, cells_[to].first);
      };
      const std::size_t row_end = rows_[r + 1].first,
                        next_end = has_next ? static_cast<std::size_t>(rows_[r + 2].first) : 0;
      const bool beside =
          narrow ? c + 1 < row_end : c + 1 < row_end && cells_[c + 1].column == cell.column + 1;
      const std::size_t own_end = narrow ? row_end : c + 1 + beside;
      for (std::int32_t a = cell.first; a < cells_[c + 1].first; ++a) meet(a, a + 1, cells_[own_end].first);
      if (narrow) {
        if (has_next) meets(rows_[r + 1].first, next_end);
        continue;
      }
      if (has_next) {
        while (below < next_end && cells_[below].column < cell.column - 1) ++below;
        std::size_t end = below;
        while (end < next_end && cells_[end].column <= cell.column + 1) ++end;
        meets(below, end);
      }
      if (period_.open()) continue;
      if (cell.column == columns_ - 1) {
        if (const std::size_t c0 = rows_[r].first; cells_[c0].column == 0) meets(c0, c0 + 1);
        if (const std::size_t c0 = rows_[r + 1].first; has_next && cells_[c0].column == 0) meets(c0, c0 + 1);
      }
      if (cell.column == 0 && has_next && cells_[next_end - 1].column == columns_ - 1)
        meets(next_end - 1, next_end);
    }
  }

 private:
  struct Row {
    std::int32_t row = 0;
    std::int32_t first = 0;  // cell
  };
  struct Place {
    std::uint64_t key = 0;
    std::int32_t body = 0;
  };

  static int coordinate(double x, double origin, double size) {
    return static_cast<int>(std::clamp(std::floor((x - origin) / size), -1e9, 2e9));
  }
  /// First row that is not below `row`, first cell of row r not left of `column`: where it is if none is
  /// missing, otherwise by bisection.
  std::size_t row_at(std::int64_t row) const;
  std::size_t cell_at(std::size_t r, std::int64_t column) const;
  std::size_t row_of_cell(std::size_t cell) const;
  template <class Visit>
  void each_in(std::size_t r, int left, int right, Visit visit) const {
    for (auto c = cell_at(r, left); c < static_cast<std::size_t>(rows_[r + 1].first); ++c) {
      if (cells_[c].column > right) break;
      for (std::int32_t k = cells_[c].first; k < cells_[c + 1].first; ++k) visit(grains_[k]);
    }
  }
  void sort_places(int bits);

  Period period_;
  WorkArray<Place> places_, sorted_;
  std::vector<NearGrain> grains_;  // cell by cell
  std::vector<Cell> cells_;        // one more marks the end
  std::vector<Row> rows_;          // those with cells; one more marks the end
  int columns_ = 0;                // of a period
  double drift_ = 0;
  double origin_x_ = 0, origin_z_ = 0, cell_x_ = 1, cell_z_ = 1;
};

/// One grid per octave of sizes: a large grain does not fill its cell with hundreds of small ones.
class GrainGrids {
 public:
  void use(WorkMemory* memory);
  /// What it holds from one search to the next.
  std::size_t bytes() const;
  /// Prepares searches for pairs of grains whose surfaces are at most `range` apart.
  void sort(const SearchedState& state, double range);
  /// Whether the grains are those that were sorted, in an open domain, and none has moved further than
  /// `farthest` along x or z: they then have their positions and velocities of now, in the same cells.
  bool follow(const SearchedState& state, double farthest, const ParallelLoops& loops);

  /// Calls `visit(grain)` for every grain whose centre is in the rectangle, and for some around it.
  template <class Visit>
  void near(double x_low, double x_high, double z_low, double z_high, Visit visit) const {
    for (const CellGrid& grid : grids()) grid.near(x_low, x_high, z_low, z_high, visit);
  }
  /// The same for a square of half edge `reach` about a position, which may reach across borders of the
  /// domain.
  template <class Visit>
  void near(Point place, double reach, Visit visit) const {
    const Point first = period_.first(place);
    for (const CellGrid& grid : grids()) near_on(grid, first.x, first.z, reach, visit);
  }

  /// Bound on how far any grain has moved along x or z since it was sorted.
  double drift() const { return drift_; }
  /// Largest diameter.
  double largest() const { return largest_.front(); }
  std::span<const CellGrid> grids() const { return std::span(grids_).first(used_); }
  /// Calls `meet(a, others)` with spans of grains such that every two grains that may be within range meet
  /// once: those of the cells [first, last) of a grid meet others.
  template <class Meet>
  void each_pair(std::size_t level, std::size_t first, std::size_t last, Meet meet) const {
    const CellGrid& grid = grids_[level];
    const auto grains = grid.grains();
    if (period_.open_z()) {
      grid.each_pair(first, last, [&](std::int32_t a, std::int32_t begin, std::int32_t end) {
        meet(grains[a], grains.subspan(begin, end - begin));
      });
    } else {
      // In a low cell two grains may be neighbours on both sides: they meet where they are nearest.
      grid.each_pair(first, last, [&](std::int32_t a, std::int32_t begin, std::int32_t end) {
        for (const NearGrain& b : grains.subspan(begin, end - begin))
          if (in_image(grains[a].z, b, 0)) meet(grains[a], std::span(&b, 1));
      });
      for (std::int32_t k = grid.cells()[first].first; k < grid.cells()[last].first; ++k) {
        const NearGrain& a = grains[k];  // those of the lowest rows are met from the highest ones
        near_in_image(grid, a.x, a.z, a.radius + largest_[level] / 2 + range_, -1,
                      [&](const NearGrain& b) { meet(a, std::span(&b, 1)); });
      }
    }
    for (std::size_t larger = 0; larger < level; ++larger)
      for (std::int32_t k = grid.cells()[first].first; k < grid.cells()[last].first; ++k) {
        const NearGrain& a = grains[k];
        near_on(grids_[larger], a.x, a.z, a.radius + largest_[larger] / 2 + range_,
                [&](const NearGrain& b) { meet(a, std::span(&b, 1)); });
      }
  }

 private:
  /// Whether b is nearest to a position at z where that is moved by so many cells along z.
  bool in_image(double z, const NearGrain& b, int cells) const {
    return std::abs(z + cells * period_.length_z - b.z) <= period_.length_z / 2;
  }
  /// Grains of a grid about a position that is moved by so many cells along z, if they are nearest to it
  /// there.
  template <class Visit>
  void near_in_image(const CellGrid& grid, double x, double z, double reach, int cells, Visit visit) const {
    const double there = z + cells * period_.length_z;
    if (there - reach > period_.origin_z + period_.length_z || there + reach < period_.origin_z) return;
    const double x_there = x + cells * period_.offset;
    grid.near(x_there - reach, x_there + reach, there - reach, there + reach, [&](const NearGrain& b) {
      if (in_image(z, b, cells)) visit(b);
    });
  }
  /// Grains of a grid in the square of half edge `reach` about a position, each once.
  template <class Visit>
  void near_on(const CellGrid& grid, double x, double z, double reach, Visit visit) const {
    if (period_.open_z()) {
      grid.near(x - reach, x + reach, z - reach, z + reach, visit);
      return;
    }
    for (const int cells : {0, -1, 1}) near_in_image(grid, x, z, reach, cells, visit);
  }

  Period period_;
  std::vector<CellGrid> grids_;  // the largest grains first; those without grains are left out
  std::size_t used_ = 0;
  std::vector<double> largest_;  // diameter in each grid
  std::vector<std::vector<std::int32_t>> members_;
  std::size_t count_ = 0;  // of the bodies that were sorted
  WorkMemory* memory_ = nullptr;
  double drift_ = 0;
  double range_ = 0;
};

}  // namespace drumlin::particles
