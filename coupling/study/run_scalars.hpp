#pragma once
// Numbers of one run that the paper speaks of and that follow from its profiles and scalars.
#include "coupling/exchange/profile_set.hpp"
#include "coupling/exchange/scalar_set.hpp"

namespace drumlin::coupling {

/// `measured` and, where it lacks them, the following (docs/formats/study.md holds the same table):
///  mu_eff, mu_eff_com     tangent of theta_deg and of theta_com_deg
///  H_over_sqrt_Q, Q_over_expected
///  nu_flowing_drop        mean nu of the static phase - mean nu of the flowing layer
///  v_z_share              mean |v_z| / mean v_x in the flowing layer
///  kinetic_share          mean of sigma_zz_kinetic / sigma_zz in the flowing layer
///  shear_rate_change      mean shear rate of the upper half of the straight line - that of the lower, over
///  their mean
///  mu_b_below             slope of mu over ln I where I < 1e-4
///  mu_b_excess            mu_b_below - mu_b
///  shear_stress_departure sigma_xz_over_weight_static - 1
///  shear_rate_laboratory  shear_rate + Omega: dv_x/dz with the drum's own turn left in
///  coriolis_share, centrifugal_share   2 Omega v_x(0) and Omega^2 (distance of the wall), over gravity
///  cos(theta)
/// A half width of means over layers is the mean of the layers' half widths, as if they moved together; that
/// of products takes the factors for independent. Half a flowing layer of fewer than three layers, or a
/// missing column, leaves NaN.
ScalarSet with_derived(const ScalarSet& measured, const ProfileSet& profiles);

}  // namespace drumlin::coupling
