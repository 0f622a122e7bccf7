#include "coupling/exchange/student.hpp"

#include <cassert>
#include <cmath>
#include <numbers>

namespace drumlin {
namespace {

/// P(|t| <= value) for integer degrees of freedom: the finite series of Abramowitz & Stegun 26.7.3
/// and 26.7.4.
double student_probability(double value, int degrees_of_freedom) {
  const double angle = std::atan(value / std::sqrt(static_cast<double>(degrees_of_freedom)));
  const double cosine = std::cos(angle), sine = std::sin(angle);
  const bool odd = degrees_of_freedom % 2 == 1;
  double term = odd ? cosine : 1.0;
  double series = 0;
  for (int power = odd ? 1 : 0; power <= degrees_of_freedom - 2; power += 2) {
    series += term;
    term *= cosine * cosine * (power + 1) / (power + 2);
  }
  return odd ? 2 / std::numbers::pi * (angle + sine * series) : sine * series;
}

}  // namespace

double student_quantile_99(int degrees_of_freedom) {
  assert(degrees_of_freedom >= 1);
  double low = 2, high = 100;  // one degree of freedom needs 63.66, infinitely many 2.576
  while (high - low > 1e-10) {
    const double middle = (low + high) / 2;
    (student_probability(middle, degrees_of_freedom) < 0.99 ? low : high) = middle;
  }
  return low;
}

double chi_squared_quantile_99(int degrees_of_freedom) {
  assert(degrees_of_freedom >= 1);
  constexpr double one_sided_99 = 2.3263478740408;
  const double spread = 2.0 / (9.0 * degrees_of_freedom);
  return degrees_of_freedom * std::pow(1 - spread + one_sided_99 * std::sqrt(spread), 3);
}

}  // namespace drumlin
