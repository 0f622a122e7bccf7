#include "coupling/core/results/kernel_nodes.hpp"

#include <string>

#include "coupling/core/basics/errors.hpp"

namespace drumlin {

MapGrid grid_over(double x_from, double x_to, double z_from, double z_to, double spacing, double width) {
  if (!(spacing > 0) || !(width >= spacing) || width > most_spacings_per_width * spacing)
    throw InputError("a map of spacing " + std::to_string(spacing) + " d with a kernel of width " +
                     std::to_string(width) + " d: the width must be 1 to " +
                     std::to_string(static_cast<int>(most_spacings_per_width)) + " spacings");
  const double first_column = std::floor(x_from / spacing), last_column = std::ceil(x_to / spacing);
  const double first_row = std::floor(z_from / spacing), end_row = std::ceil(z_to / spacing);
  MapGrid grid;
  grid.spacing_z = grid.spacing_x = spacing;
  grid.x_first = first_column * spacing;
  grid.columns = static_cast<std::size_t>(last_column - first_column) + 1;
  grid.z_first = (first_row + 0.5) * spacing;
  grid.rows = static_cast<std::size_t>(std::max(1.0, end_row - first_row));
  return grid;
}

}  // namespace drumlin
