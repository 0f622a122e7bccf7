// Apart from the rest: deal.II's estimator costs a compiler as much time as all of discretisation.cpp.
#include <deal.II/numerics/error_estimator.h>

#include "continuum/fem/detail/discretisation.hpp"

namespace drumlin::continuum::fem {

dealii::Vector<float> velocity_error_indicator(const Discretisation& d, const FieldVector& solution) {
  dealii::Vector<float> indicator(d.mesh.n_active_cells());
  dealii::KellyErrorEstimator<2>::estimate(d.mapping, d.unknowns, dealii::QGauss<1>(3), {}, solution,
                                           indicator, d.velocity_mask());
  return indicator;
}

}  // namespace drumlin::continuum::fem
