#pragma once
// mu(I) = a + b ln I fitted to the layers of particle profiles.
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "coupling/core/law/rheology_fit.hpp"
#include "coupling/core/results/profile_set.hpp"

namespace drumlin::coupling {

/// One layer: its inertial number and effective friction with their standard errors (NaN: not known).
struct FrictionPoint {
  double I = 0;
  double mu = 0;
  double I_error = 0;
  double mu_error = 0;
};

/// An error in a sum: one that is not known adds nothing.
inline double known(double error) { return std::isfinite(error) ? error : 0; }

/// Which layers of a profile speak about the law; lengths in d.
struct LayerSelection {
  double I_min = 1e-4;
  double I_max = 1e-1;
  double surface_margin = 2;  ///< the surface layer is loose and mixes with the air above
  double wall_margin = 3;     ///< grains order along the wall
};

/// Layers of a particle profile within the selection. The wall is where the header's "wall_z" says, else at
/// the lowest layer. Needs the columns I and `of`, which stands in the place of mu.
std::vector<FrictionPoint> friction_points(const ProfileSet& profiles, const LayerSelection& selection,
                                           const std::string& of = "mu");

/// A fit and how well it describes its points.
struct FrictionFit {
  LogLaw law;                    ///< I_min, I_max: smallest and largest I of the points
  double rms_misfit = 0;         ///< of mu
  double intrinsic_scatter = 0;  ///< standard deviation of mu beyond the errors of the points
  double birge_ratio =
      0;  ///< root of the reduced chi^2 without intrinsic scatter; NaN when no error is known
  std::size_t points = 0;
};

/// Least squares of mu on ln I, weights 1/(mu_error^2 + (b I_error/I)^2 + s^2): errors of I count through the
/// slope
/// ("effective variance": Orear, Am. J. Phys. 50 (1982) 912), and the intrinsic scatter s is what makes the
/// reduced chi^2 one (Mandel and Paule, Anal. Chem. 42 (1970) 1194), zero if it is below one already. Without
/// s the layers measured best would rule the fit although the logarithm itself is off by more than their
/// errors. The covariance is that of these weights; it takes the layers for independent, so that it is a
/// lower bound where misfit is systematic. Throws InputError with fewer than three points or when all have
/// the same I.
FrictionFit fit_log_friction(const std::vector<FrictionPoint>& points);

/// Half width of the 99 % interval of a coefficient from its variance in fit.law.covariance: the larger of
/// the normal quantile and Student's t with points - 2 degrees of freedom times the Birge ratio, which the
/// intrinsic scatter brings to one where it exceeds one.
double half_width_99(const FrictionFit& fit, double variance);

}  // namespace drumlin::coupling
