#pragma once
// Reference flows across one gap for any law, by inversion of the law and quadrature; the finite elements are
// compared with them. With a vanishing regularisation these are the closed forms of GDR MiDi, Eur. Phys. J. E
// 14 (2004).
#include <span>
#include <vector>

#include "continuum/model/gap.hpp"
#include "continuum/rheology/tensor_law.hpp"

namespace drumlin::continuum {

/// Shear rate (>= 0) at which the regularised law carries this shear stress (>= 0) under the law's pressure
/// p, which is regularised here; by bisection down to rounding. 0 below 1e-30: that is rest.
double shear_rate(const StressLaw& law, const Regularisation& regularisation, double p, double shear_stress);

struct GapSolution {
  double top_shear_stress = 0;
  double top_speed = 0;            ///< relative to the wall at rest
  double Q = 0;                    ///< integral of nu v_x over the gap
  std::vector<double> speed;       ///< v_x at the distances asked for
  std::vector<double> shear_rate;  ///< there: dv_x/dz, in an annulus r d(v_x/r)/dz
};

/// The steady flow across the gap. A given speed of the driven wall fixes the shear stress, by bisection.
/// `distances` from the top ascend. Quadrature errs by a few 1e-8 where the shear rate is smooth, more at the
/// top of an incline (1e-6), whose shear rate starts as a root.
GapSolution gap_solution(const Gap& gap, const StressLaw& law, const Regularisation& regularisation,
                         std::span<const double> distances);

}  // namespace drumlin::continuum
