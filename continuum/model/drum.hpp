#pragma once
// The drum of a flow scene as a FlowProblem.
#include "continuum/model/flow_problem.hpp"
#include "continuum/model/flow_scene.hpp"
#include "coupling/exchange/rheology_fit.hpp"

namespace drumlin {

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

/// The wall's velocity, rising from nought over `taper` from the ends of the surface: there the wall would
/// drag material through it.
Vec2 tapered_wall_velocity(const DrumGeometry& drum, double taper, Vec2 point, Vec2 left, Vec2 right);

/// Laboratory frame, fixed chord, slope from the moment of the surface traction; on the wall the drum's
/// velocity, rising from nought over corner_taper at both ends of the chord: there the wall would drag
/// material through the surface.
FlowProblem drum_problem(const FlowScene& scene, const DrumGeometry& drum, const StressLaw& law);

/// The same for other geometries than a scene's.
FlowProblem drum_problem(const DrumGeometry& drum, const StressLaw& law, const FlowMesh& mesh,
                         const FlowBoundary& boundary, const FlowRegularisation& regularisation);

}  // namespace drumlin
