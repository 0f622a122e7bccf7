#pragma once
// Bilinear weights of the four points of a grid around a place.
#include <cmath>

namespace drumlin {

/// Calls action(column, row, weight), whole numbers and weights of sum 1, from the lower row up. `column` and
/// `row`: the place, in spacings of the grid.
template <class Action>
void each_corner(double column, double row, Action action) {
  const double west = std::floor(column), south = std::floor(row), east = column - west, north = row - south;
  for (const int up : {0, 1})
    for (const int right : {0, 1})
      action(west + right, south + up, (right ? east : 1 - east) * (up ? north : 1 - north));
}

}  // namespace drumlin
