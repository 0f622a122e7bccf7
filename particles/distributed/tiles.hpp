#pragma once
// Tiles: what orders the contacts of a run, whatever the number of ranks.
#include <algorithm>
#include <cstdint>
#include <vector>

#include "particles/bodies/walls.hpp"

namespace drumlin::particles {

/// A square of 2^levels x 2^levels cells. A tile is two cells high and 2 / cut cells wide.
struct TileGrid {
  Point origin;          ///< its lower left corner
  double cell = 1;       ///< edge of a cell
  int levels = 1;        ///< at least 1
  std::int32_t cut = 1;  ///< tiles side by side in a square of 2 x 2 cells, which one rank owns: a power of 2

  int cells_per_side() const { return 1 << levels; }
  std::int32_t rows() const { return 1 << (levels - 1); }
  std::int32_t columns() const { return cut * rows(); }
  std::int32_t count() const { return columns() * rows(); }  ///< see tile_grid()
  double edge() const { return cell * cells_per_side(); }
  double tile_width() const { return 2 * cell / cut; }
  /// What a cell must be at least, if tiles are to be two of them wide (docs/decisions/ranks.md).
  double needed_cell() const { return cell / cut; }
  bool contains(Point p) const {
    return p.x >= origin.x && p.z >= origin.z && p.x < origin.x + edge() && p.z < origin.z + edge();
  }
  /// Number of the tile of a point, row by row; points outside count to the nearest.
  std::int32_t tile_at(Point p) const {
    // Asked for every pair of a step: a loop divides once.
    const double rows_per_length = 1 / (2 * cell), columns_per_length = cut / (2 * cell);
    const auto place = [](double along, std::int32_t count) {
      return static_cast<std::int32_t>(std::clamp(along, 0.0, count - 1.0));
    };
    return place((p.z - origin.z) * rows_per_length, rows()) * columns() +
           place((p.x - origin.x) * columns_per_length, columns());
  }
  std::int32_t column(std::int32_t tile) const { return tile % columns(); }
  std::int32_t row(std::int32_t tile) const { return tile / columns(); }
  /// The first tile of the square of 2 x 2 cells that a point lies in.
  std::int32_t first_of_square(Point p) const {
    const std::int32_t tile = tile_at(p);
    return tile - column(tile) % cut;
  }
  /// By the parities of column and row, 0 to 3: 0 and 1 in even columns.
  int colour(std::int32_t tile) const { return row(tile) % 2 + 2 * (column(tile) % 2); }
  /// Strip k: columns 2k and 2k + 1. Bodies belong to it from the middle of column 2k - 1 to that of 2k + 1,
  /// so that only contacts of odd columns touch bodies of two strips.
  std::int32_t strips() const { return (columns() + 1) / 2; }
  std::int32_t strip_of_tile(std::int32_t tile) const { return column(tile) / 2; }
  std::int32_t strip_of_body(double x) const {
    const double strips_per_length = cut / (4 * cell);
    return static_cast<std::int32_t>(
        std::clamp((x - origin.x) * strips_per_length + 0.25, 0.0, strips() - 1.0));
  }
  bool operator==(const TileGrid& other) const {
    return origin.x == other.origin.x && origin.z == other.origin.z && cell == other.cell &&
           levels == other.levels && cut == other.cut;
  }
};

/// Who owns each tile.
struct TileMap {
  TileGrid grid;
  std::vector<std::int32_t> owner;  ///< rank of each tile
  std::int32_t owner_at(Point p) const { return owner[grid.tile_at(p)]; }
};

/// What a step can bridge, and how large cells must be for it.
struct Reach {
  double largest = 0;   ///< diameter of a grain
  double margin = 0;    ///< pairs closer than this are always candidates
  double approach = 0;  ///< bound on 2 h times the approach speed of any pair
  double way = 0;       ///< bound on the way of a grain within the step
};

/// Cells must be so large that a rank which knows the grains of one layer of cells around its own finds all
/// contacts of every grain that its contacts touch (docs/decisions/ranks.md).
double least_cell(const Reach&);
/// How far grains may have moved since they were sorted into cells of this size: what a rank must see is then
/// still in the cells that it sees. Negative where the cells are too small.
double most_drift(const Reach&, double cell);
/// Grids of so many needed cells a side, and of twice as many, have cells that are twice and four times as
/// large as they must be, in squares that are cut into 2 and 4 tiles: as wide as ever, but higher. Then more
/// contacts stand in a tile, so that vectors are fuller and wait less for each other, and there are fewer
/// cells to manage; more grains are ghosts for it.
inline constexpr int least_cells_of_high_tiles = 128;
/// The smallest grid whose needed cells are large enough and which covers the square from `low` of edge
/// `edge`. Needed cells grow by steps of sqrt(2), so that most steps have that of the step before; nothing
/// but the arguments decides, so that a run that is continued has the same tiles. Cells are larger than that
/// where there would be many more tiles than grains: few grains in a wide place.
TileGrid tile_grid(Point low, double edge, const Reach&, std::int64_t grains);

}  // namespace drumlin::particles
