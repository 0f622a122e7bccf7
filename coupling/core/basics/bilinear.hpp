#pragma once
// Bilinear weights of the four points of a grid around a place.
#include <cmath>

namespace drumlin {

/// Calls action(column, row, weight), whole numbers and weights of sum 1, from the lower row up. `column` and
/// `row`: the place, in spacings of the grid.
template <class Action>
void each_corner(double column, double row, Action action) {
  const double west = std::floor(column), south = std::floor(row);
  for (const double up : {0.0, 1.0})
    for (const double right : {0.0, 1.0})
      action(west + right, south + up,
             (1 - std::abs(column - west - right)) * (1 - std::abs(row - south - up)));
}

}  // namespace drumlin
