#pragma once
// What contacts carry in a packing that stands: where its first step starts from.
#include <span>

#include "particles/bodies/bodies.hpp"
#include "particles/bodies/walls.hpp"
#include "particles/detection/cell_grid.hpp"
#include "particles/scene/scene.hpp"
#include "particles/stepping/impulse_cache.hpp"

namespace drumlin::particles {

/// Whether grains of the scene start in hollows, where they stand.
bool starts_deposited(const Scene& scene);

/// Normal impulses of a step of length `time_step` under the pressure p of the grains above each contact, as
/// in a liquid: r_n = 2 p A h/(N l), for N contacts of lengths l in an area A, from the mean stress
/// sum r_n l/(2 A). They balance over long distances and not at each grain; sweeps mend that soon, but carry
/// a load from the top of a deep bed to its bottom only a few layers at a time. `unknowns`: per contact.
/// `gravity`: acceleration, dimensionless.
ImpulseCache impulses_under_weight(const Bodies& bodies, std::span<const Shape> shapes, const Period& period,
                                   const Point& gravity, double time_step, int unknowns);

}  // namespace drumlin::particles
