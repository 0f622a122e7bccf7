#pragma once
// How the mesh of a region follows its material: the arbitrary Lagrangian-Eulerian motion of the corners of
// its triangles. The free surface moves with the material, walls keep theirs, and what lies between follows
// evenly.
#include <span>
#include <vector>

#include "continuum/model/outline.hpp"

namespace drumlin::continuum {

/// Velocity of the wall itself at a time, of its surface: what material without slip has there.
Vec2 wall_velocity(const RegionPart& part, double time, Vec2 point);
/// The same; where another wall meets it, the velocity that passes neither.
Vec2 wall_velocity(const Region& region, std::size_t number, double time, Vec2 point);
/// Of the place of the wall: a circle that turns stays where it is.
Vec2 wall_motion(const RegionPart& part, double time);
/// What the material does at the corners of the triangles; of the free surface also what flows through it:
/// integrals over its sides with each corner's hat function.
struct CornerMotion {
  std::vector<Vec2> velocity;
  std::vector<Vec2> free_normal;  ///< integral of n; nought inside
  std::vector<double> free_flux;  ///< integral of u.n
};

/// Velocity of each corner. With it the area under the free surface changes as material flows, to rounding
/// (that of a step, with the mesh at its middle): normal velocities of free corners follow from the flux, a
/// contact of the surface with a wall moves along it as the flux asks.
std::vector<Vec2> corner_velocities(const Region& region, double time, const RegionMesh& mesh,
                                    std::span<const Vec2> corners, const CornerMotion& material);

/// Corners that a step from `time` on would bring to x: those on circles on them again; a contact that would
/// pass the end of a wall which moves along its own at that end. `mesh`: at the start of the step.
std::vector<Vec2> held_by_walls(const Region& region, double time, double step, const RegionMesh& mesh,
                                const SizeField& size, std::vector<Vec2> x);

}  // namespace drumlin::continuum
