#pragma once
// A solved drum as profiles, scalars and maps: what the particle side leaves too, with the same names.
#include "continuum/fem/flow_field.hpp"
#include "continuum/model/drum.hpp"
#include "continuum/postprocessing/flow_maps.hpp"
#include "coupling/core/results/profile_set.hpp"
#include "coupling/core/results/scalar_set.hpp"

namespace drumlin::continuum {

struct SliceOptions {
  double width = 20;           ///< d; cut to a quarter of the chord, as on the particle side
  double layer_thickness = 1;  ///< d
};
double slice_width(const SliceOptions& slice, const DrumGeometry& drum);

/// Height of the surface at x = 0 above the chord; nought where it has not moved.
double middle_height(const FlowField& field);

/// Averages over the layers of the slice at x = 0, down from the surface there: v_x, v_z, shear_rate
/// (dv_x/dz) in the frame of the drum, nu, sigma_xx, sigma_zz, sigma_xz; I = shear_rate/sqrt(sigma_zz), mu
/// and k from these averages (NaN where sigma_zz <= 0). Headers are the caller's.
ProfileSet drum_profiles(const FlowField& field, const DrumGeometry& drum, const SliceOptions& slice = {});

/// Q = integral of nu (v_x - Omega z') over the depth at x = 0, from the velocity alone.
double discharge(const FlowField& field, const DrumGeometry& drum);

/// Through each of `cuts` straight lines from the middle of the chord to the wall, moved with the mesh where
/// the surface has moved, as much flows in (in the laboratory frame, against the sense of the rotation) as
/// out: the largest |in - out| nu/Q of them, Q from mass balance. The wall turns along itself and nothing
/// crosses the chord, so that 0 is exact at any fill; what is left is what the spring lets through and what
/// the elements do not conserve.
double flux_imbalance(const FlowField& field, const DrumGeometry& drum, int cuts = 33);

/// theta_deg, Q, H, lambda, shear_rate, I_th; the definitions of coupling/core/results/profile_scalars.hpp.
ScalarSet drum_scalars(const FlowField& field, const DrumGeometry& drum, const ProfileSet& profiles);

/// Identities of the exact flow, each side computed by itself: Q against mass balance, dissipation against
/// power, the torque of wall and surface against that of the weight about the axis.
ScalarSet drum_checks(const FlowField& field, const DrumGeometry& drum);

/// The part of the drum below the surface of the field; z from its middle as in the profiles, velocities in
/// the frame of the drum.
MapArea drum_map_area(const FlowField& field, const DrumGeometry& drum);

}  // namespace drumlin::continuum
