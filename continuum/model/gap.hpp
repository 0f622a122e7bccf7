#pragma once
// Flows across one gap: incline, plane shear, vertical chute, annulus. Their speed depends on one coordinate
// alone, the distance y from the top, which is the free surface, the driven wall, or the middle of the chute.
#include <optional>
#include <string>

#include "continuum/model/flow_problem.hpp"
#include "continuum/model/flow_scene.hpp"
#include "coupling/core/basics/geometry.hpp"
#include "coupling/core/law/rheology_fit.hpp"

namespace drumlin::continuum {

/// A gap in units of its grains. The flow runs along x, towards which the weight pulls or the driven wall
/// moves; z = -y points at the top. In an annulus the top is the inner wall, and x and z turn with the place:
/// z points at the axis, and the inner wall turns anticlockwise, so that dv_x/dz > 0 as everywhere.
struct Gap {
  double depth = 0;         ///< from the top to the wall at rest
  double inner_radius = 0;  ///< of an annulus; 0: straight
  double nu = 0;
  double weight = 0;                 ///< nu where the weight acts, else 0
  double slope = 0;                  ///< rad, of x against the horizontal; pi/2 in a chute
  double pressure = 0;               ///< sigma_zz at the top, rho0 g d; in an annulus everywhere
  std::optional<double> speed = {};  ///< of the driven wall; absent: no shear stress at the top
  bool flows_at_wall = false;        ///< the shear is strongest at the wall at rest: there the mesh is fine
  Geometry geometry = Geometry::incline;
  /// Names of the results that mean something here (continuum/postprocessing/gap_profiles.hpp).
  std::vector<std::string> scalars = {};
};

/// The gap of a scene's geometry, in the units of its grains; nu is the law's.
Gap gap_of(const FlowIncline& incline, const Scales& scales, double nu);
Gap gap_of(const FlowPlaneShear& shear, const Scales& scales, double nu);
Gap gap_of(const FlowChute& chute, const Scales& scales, double nu);
Gap gap_of(const FlowAnnulus& ring, const Scales& scales, double nu);
/// Of a scene with one of these.
Gap gap_of(const FlowScene& scene, double nu);

/// sigma_zz at the distance y from the top, from statics (k = 1 in an annulus).
double gap_pressure(const Gap& gap, double y);
/// sigma_xz there, given its value at the top: with the weight along x, and as 1/r^2 in an annulus.
double gap_shear_stress(const Gap& gap, double top_shear_stress, double y);

/// The gap of a scene with a law, complete: mu, k, weight, sides, and every effect that the scene names.
/// Throws InputError if the law does not allow an effect of the scene, or the effect needs a drum.
FlowProblem gap_problem(const FlowScene& scene, const RheologyFit& law);

/// A gap with a friction law alone: no k, no effects. Straight gaps become a periodic strip two cells wide,
/// the annulus a whole ring. A driven wall: PressedWall above in plane shear, the given velocity of the inner
/// wall and a PressedWall outside in an annulus (both walls at given velocities would leave the pressure
/// open).
FlowProblem gap_problem(const Gap& gap, const StressLaw& law, const FlowMesh& mesh,
                        const FlowRegularisation& regularisation);

/// Place at the distance y from the top and the share s in [0, 1) of the way along the flow, with the axes
/// there.
struct GapPlace {
  Vec2 point;
  Vec2 along;   ///< x of the flow
  Vec2 upward;  ///< z of the flow
};
GapPlace gap_place(const Gap& gap, double y, double s);

}  // namespace drumlin::continuum
