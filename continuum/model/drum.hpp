#pragma once
// A rotating drum as a flow problem: its geometry in units of the grains, and all that a scene and a law say
// of it.
#include "continuum/model/flow_problem.hpp"
#include "continuum/model/flow_scene.hpp"
#include "coupling/core/law/rheology_fit.hpp"

namespace drumlin::continuum {

/// A drum in units of its grains: what crosses from the particles besides the law.
struct DrumGeometry {
  double radius = 0;
  double axis_offset = 0;  ///< height of the axis above the surface
  double rotation = 0;     ///< positive in the sense of dv_x/dz
  double nu = 0;
  std::optional<double> slope = {};  ///< rad, prescribed; absent: the one at which the surface has no moment
  double half_chord() const;
  /// nu Omega (R^2 - c^2)/2, c being the height of the axis above the surface at x = 0, which may have risen:
  /// what mass balance makes of any steady flow that nothing crosses at the surface. The solver never uses
  /// it; a check.
  double expected_Q(double surface_height = 0) const;
};

/// Of a scene with a drum. Throws InputError if the grains, at the law's nu, do not fit into the drum.
DrumGeometry drum_geometry(const FlowScene& scene, double nu);

/// Velocity of the material at the wall: the share 1 - exp(-s/l) of the wall's for each end of the surface, s
/// being the distance from it. l is `length` where that end is at z = 0 and grows with its height by 0.3, a
/// quarter of `length` at least. Measured where material meets the wall (docs/results/bed.md).
Vec2 entraining_wall_velocity(const DrumGeometry& drum, double length, Vec2 point, Vec2 left, Vec2 right);

/// The drum of a scene with a law, complete: mu, k, weight, sides, and every effect that the scene names.
/// Laboratory frame, chord at z = 0, slope from the moment of the surface traction unless the scene gives it.
/// On the wall entraining_wall_velocity(). Throws
/// InputError if the grains do not fit into the drum or the law does not allow an effect of the scene.
FlowProblem drum_problem(const FlowScene& scene, const RheologyFit& law);

/// A drum of any size with a friction law alone: no k, no effects; the rest as above.
FlowProblem drum_problem(const DrumGeometry& drum, const StressLaw& law, const FlowMesh& mesh,
                         const FlowBoundary& boundary, const FlowRegularisation& regularisation);

}  // namespace drumlin::continuum
