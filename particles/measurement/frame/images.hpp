#pragma once
// The images of a point in a periodic domain.
#include <cmath>

#include "particles/bodies/period.hpp"
#include "particles/measurement/frame/disc_area.hpp"
#include "particles/measurement/frame/moments.hpp"

namespace drumlin::particles {

/// Calls action(image) for those in a window, along axes that are periodic; for the point itself in an open
/// domain.
template <class Action>
void each_image(const Period& period, const Vector<2>& at, const Rectangle& window, Action action) {
  if (period.open()) return action(at);
  const bool one_row = period.open_z();
  const double last_row = one_row ? 0 : std::floor((window.z_max - at[1]) / period.length_z);
  for (double row = one_row ? 0 : std::ceil((window.z_min - at[1]) / period.length_z); row <= last_row;
       ++row) {
    const double row_x = at[0] + row * period.offset;
    const double last_column = std::floor((window.x_max - row_x) / period.length);
    for (double column = std::ceil((window.x_min - row_x) / period.length); column <= last_column; ++column)
      action(Vector<2>{row_x + column * period.length, at[1] + row * period.length_z});
  }
}

}  // namespace drumlin::particles
