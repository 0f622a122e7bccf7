#pragma once
// Numbers read off a profile at the centre of a drum: the same definitions for both simulators
// (docs/theory/measurement.md).
#include <limits>
#include <string>

#include "coupling/core/results/profile_set.hpp"

namespace drumlin {

/// The windows of the definitions; in d and in shares of the surface speed.
struct ProfileScalarOptions {
  double surface_speed_depth =
      1.0;                    ///< v_x(0) is read here: the layers at the surface itself hold few grains
  double linear_share = 0.3;  ///< the straight line is fitted where v_x exceeds this share of v_x(0)
  double decay_from = 8.0;    ///< lambda is fitted between -H - decay_from ...
  double decay_to = 2.0;      ///< ... and -H - decay_to
  const char* decay_of = "shear_rate";  ///< column that decays: "shear_rate", or "v_x"
};

/// Dimensionless (d, sqrt(d/g)); NaN where the profile does not hold what a definition needs.
struct ProfileScalars {
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();
  double surface_speed = none;  ///< v_x(0)
  double Q = none;              ///< integral of nu v_x over z, from the wall to above the surface
  double shear_rate = none;     ///< slope of the straight line through v_x(z) of the flowing layer
  double H = none;              ///< depth at which that line reaches zero
  double lambda = none;         ///< decay length of the shear rate below the flowing layer
  double decay_log_rate =
      none;            ///< ln of the fitted shear rate at z = 0: rate(z) = exp(decay_log_rate + z/lambda)
  double I_th = none;  ///< inertial number at z = -H
  double fit_bottom = none;  ///< lowest layer of the straight line
  double fit_top = none;     ///< highest one
};

/// Needs the column v_x; Q needs nu as well, lambda needs shear_rate, I_th needs I: each is NaN without. The
/// layers of the line hang together from the surface downwards; lambda is NaN when its window leaves the
/// profile or holds a layer that does not shear forwards. Unweighted fits, so that a profile without
/// intervals gives the same numbers.
ProfileScalars profile_scalars(const ProfileSet& profiles, const ProfileScalarOptions& options = {});

/// Decay length of a column (as lambda, of shear_rate) between from and to; NaN when this window leaves the
/// profile, or when a layer in it shears backwards or all do not decay downwards.
double decay_length(const ProfileSet& profiles, double from, double to,
                    const std::string& column = "shear_rate");

}  // namespace drumlin
