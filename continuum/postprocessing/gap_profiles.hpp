#pragma once
// A solved flow across a gap as profiles, scalars, checks, and beside its closed form.
#include "continuum/model/gap.hpp"
#include "continuum/postprocessing/flow_maps.hpp"
#include "coupling/core/results/profile_set.hpp"
#include "coupling/core/results/scalar_set.hpp"

namespace drumlin::continuum {

/// Averages over layers across the gap, z = 0 at its top: v_x, v_z, shear_rate, nu, sigma_xx, sigma_zz,
/// sigma_xz, I, mu, k as in a drum; laboratory frame, axes along the flow (continuum/model/gap.hpp). Headers
/// are the caller's.
ProfileSet gap_profiles(const FlowField& field, const Gap& gap, double layer_thickness);

/// Those of these that mean something in the gap (Gap::scalars): theta_deg, Q, surface_speed (at the top;
/// of the plug in a chute), mean_speed, shear_rate (mean), I (mean), mu_wall (shear stress over pressure at
/// the driven wall, from the power that it puts in, else at the wall at rest, from its force), torque (of the
/// inner wall), lambda = v_x/(dv_x/dz) at the inner wall.
ScalarSet gap_scalars(const FlowField& field, const Gap& gap);

/// Identities of the exact flow, each side computed by itself: forces or torques of the walls against each
/// other and the weight, dissipation against power; and how far Q differs between eight places along the
/// flow.
ScalarSet gap_checks(const FlowField& field, const Gap& gap);

/// The finite elements beside the solution across the gap by inversion of the law and quadrature.
struct GapComparison {
  /// Relative error of v_x in L2 over the gap against the solution for the same regularised law: what the
  /// mesh and the solver leave.
  double mesh_error = 0;
  double mesh_error_max = 0;  ///< the largest difference over the largest speed
  /// The same against the law without regularisation, its closed form: what eps and p_min add is in this one.
  double closed_form_error = 0;
  double closed_form_error_max = 0;
  /// Speed at the top for the regularised law, exact, and for the same with eps -> 0: of a layer that its
  /// weight cannot move the first is that of eps alone.
  double speed = 0, speed_without_eps = 0;
  ScalarSet closed_form;  ///< scalars of the closed form, under the names of gap_scalars
  std::vector<double> z, v_x, v_x_closed_form;  ///< at points across the gap
};
GapComparison gap_comparison(const FlowField& field, const Gap& gap, const StressLaw& law,
                             const Regularisation& regularisation);

MapArea gap_map_area(const Gap& gap, double strip_width);

}  // namespace drumlin::continuum
