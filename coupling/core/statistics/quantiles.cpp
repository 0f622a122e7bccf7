#include "coupling/core/statistics/quantiles.hpp"

#include <boost/math/distributions/students_t.hpp>
#include <cassert>
#include <cmath>

namespace drumlin::statistics {

double student_quantile_99(int degrees_of_freedom) {
  assert(degrees_of_freedom >= 1);
  return boost::math::quantile(boost::math::students_t(degrees_of_freedom), 0.995);
}

double quantile_99_of_stated_errors(double reduced_chi2, int degrees_of_freedom) {
  if (degrees_of_freedom < 1) return normal_quantile_99;
  return std::fmax(normal_quantile_99, student_quantile_99(degrees_of_freedom) * std::sqrt(reduced_chi2));
}

}  // namespace drumlin::statistics
