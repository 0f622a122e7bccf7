#include "particles/distributed/tiles.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace drumlin::particles {

std::int32_t TileGrid::tile_at(Point p) const {
  const double tile = 2 * cell;
  const auto place = [&](double along) {
    return static_cast<std::int32_t>(std::clamp(std::floor(along / tile), 0.0, per_side() - 1.0));
  };
  return place(p.z - origin.z) * per_side() + place(p.x - origin.x);
}

double least_cell(const Reach& reach) {
  // Centres of pairs that push each other on, and of all candidates.
  const double near = reach.largest + reach.margin + reach.approach, far = near + reach.approach;
  // A contact of ours touches grains up to far/2 outside, whose partners are up to 1.5 far outside, and what
  // those approach is `near` further.
  constexpr double slack = 1 + 1e-6;  // places are sorted into cells with rounding
  return slack * std::max(1.5 * far + near, 2 * reach.way);
}

TileGrid tile_grid(Point low, double edge, const Reach& reach) {
  const double smallest = 3 * reach.largest, least = least_cell(reach);
  TileGrid grid;
  grid.origin = low;
  grid.cell = smallest;
  for (int steps = 1; grid.cell < least; ++steps)
    grid.cell = smallest * (steps % 2 == 0 ? 1 : std::numbers::sqrt2) * std::exp2(steps / 2);
  while (grid.edge() < edge) ++grid.levels;
  return grid;
}

}  // namespace drumlin::particles
