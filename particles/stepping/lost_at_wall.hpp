#pragma once
// Whether a grain of a contact with a wall is lost.
#include <optional>

#include "particles/bodies/period.hpp"
#include "particles/effects/wall_step.hpp"
#include "particles/stepping/lost_grain.hpp"
#include "particles/stepping/position_projection.hpp"

namespace drumlin::particles {

/// Of a pair of a grain and a wall at the end of a step; `loaded`: it carried an impulse.
inline std::optional<LostGrain> lost_at_wall(const ClosePair& pair, bool loaded, const Bodies& bodies,
                                             const WallStep& walls, const Period& period) {
  const std::size_t shape = -1 - pair.j;
  const double x = bodies.x[pair.i], z = bodies.z[pair.i], radius = bodies.radius[pair.i];
  if (has_left(walls.after[shape], radius, pair.gap))
    return LostGrain{pair.i, x, z, LostGrain::How::left_container};
  if (loaded && pushed_too_far(walls.after[shape], walls.displacement[shape], {period.first(x), z},
                               {pair.n_x, pair.n_z}, radius))
    return LostGrain{pair.i, x, z, LostGrain::How::pushed_too_far};
  return std::nullopt;
}

}  // namespace drumlin::particles
