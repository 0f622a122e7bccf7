#pragma once
// What stress and velocity gradient at a point say without axes: one definition for both sides
// (docs/theory/coarse-graining.md).
#include <limits>

namespace drumlin {

/// Components of a tensor in the plane; need not be symmetric.
struct PlaneMatrix {
  double xx = 0, xz = 0, zx = 0, zz = 0;
};

/// NaN where the pressure is not positive (tau apart) or where an argument is.
struct PlaneInvariants {
  double strain_rate = std::numeric_limits<double>::quiet_NaN();     ///< 2 sqrt(D:D/2), 1/sqrt(d/g)
  double half_vorticity = std::numeric_limits<double>::quiet_NaN();  ///< (d_v_x_dz - d_v_z_dx)/2
  double p = std::numeric_limits<double>::quiet_NaN();               ///< mean of the normal stresses
  double tau = std::numeric_limits<double>::quiet_NaN();  ///< half the difference of the principal stresses
  double I = std::numeric_limits<double>::quiet_NaN();    ///< strain_rate/sqrt(p)
  double mu = std::numeric_limits<double>::quiet_NaN();   ///< tau/p
  double k = std::numeric_limits<double>::quiet_NaN();    ///< xx/zz of the stress: depends on the axes
  double axis_angle_deg = std::numeric_limits<double>::quiet_NaN();  ///< see the function of that name
};

/// `pressure`: stress, compression positive, its off-diagonal entries with the sign of such a tensor
/// (sigma_xz of the conventions is -pressure.xz). `gradient`: xz is d_v_x_dz, zx is d_v_z_dx. Only the
/// symmetric part of the stress counts.
PlaneInvariants plane_invariants(const PlaneMatrix& pressure, const PlaneMatrix& gradient);

/// Angle by which the axis of the greatest pressure is turned from the axis of the fastest shortening, in
/// degrees, anticlockwise with x to the right and z up; in (-90, 90]. Arguments as above. Simple shear has
/// tan(2 angle) = (k - 1)/(2 mu).
double axis_angle_deg(const PlaneMatrix& pressure, const PlaneMatrix& gradient);

/// The angle plus the multiple of `period` that brings it nearest to 0: axes 180 degrees apart are one axis.
double nearest_turn(double angle, double period);

}  // namespace drumlin
