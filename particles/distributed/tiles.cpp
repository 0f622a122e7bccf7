#include "particles/distributed/tiles.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace drumlin::particles {

namespace {

constexpr int most_levels = 24;     // columns are counted in 32 bits
constexpr double slack = 1 + 1e-6;  // places are sorted into cells with rounding

// Centres of pairs that push each other on, and of all candidates.
double near_of(const Reach& reach) { return reach.largest + reach.margin + reach.approach; }
double far_of(const Reach& reach) { return near_of(reach) + reach.approach; }

// A contact of ours touches grains up to far/2 outside, whose partners are up to 1.5 far outside, and what
// those approach is `near` further.
double seen_by(const Reach& reach) { return 1.5 * far_of(reach) + near_of(reach); }

/// Each tile costs a step some microseconds, whether grains are in it or not.
std::int64_t most_tiles(std::int64_t grains) {
  constexpr std::int64_t most = std::int64_t{1} << 26;
  return std::min(most, 16 * grains + 4096);
}

}  // namespace

double least_cell(const Reach& reach) { return slack * std::max(seen_by(reach), 2 * reach.way); }

double most_drift(const Reach& reach, double cell) {
  // Half of far: partners of a grain of ours that stands so far outside are then no further than seen_by().
  return std::min(cell / slack - seen_by(reach), far_of(reach) / 2);
}

TileGrid tile_grid(Point low, double edge, const Reach& reach, std::int64_t grains) {
  const double smallest = 3 * reach.largest, least = least_cell(reach);
  TileGrid grid;
  grid.origin = low;
  grid.cell = smallest;
  for (int steps = 1; grid.cell < least; ++steps)
    grid.cell = smallest * (steps % 2 == 0 ? 1 : std::numbers::sqrt2) * std::exp2(steps / 2);
  for (; grid.edge() < edge; ++grid.levels)
    if (grid.levels == most_levels) --grid.levels, grid.cell *= 2;
  for (int factor = 2; factor <= 4 && grid.cells_per_side() >= least_cells_of_high_tiles; factor *= 2) {
    grid.cell *= 2, --grid.levels;
    grid.cut = factor;
  }
  const auto tiles = [&] { return std::int64_t{grid.columns()} * grid.rows(); };
  for (; grid.levels > 1 && tiles() > most_tiles(grains); --grid.levels) grid.cell *= 2;
  return grid;
}

}  // namespace drumlin::particles
