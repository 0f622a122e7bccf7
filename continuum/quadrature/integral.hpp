#pragma once
// Adaptive quadrature of a function of one variable.
#include <algorithm>
#include <cmath>

namespace drumlin::continuum {

namespace detail {

// Simpson's rule on [a, b] with its values, halved until the two halves agree with the whole.
template <class Function>
double simpson(const Function& f, double a, double b, double fa, double fm, double fb, double whole,
               double tolerance, int halvings) {
  const double m = 0.5 * (a + b), left_m = f(0.5 * (a + m)), right_m = f(0.5 * (m + b));
  const double left = (m - a) / 6 * (fa + 4 * left_m + fm), right = (b - m) / 6 * (fm + 4 * right_m + fb);
  const double change = left + right - whole;
  if (halvings == 0 || std::abs(change) <= 15 * tolerance) return left + right + change / 15;
  return simpson(f, a, m, fa, left_m, fm, left, 0.5 * tolerance, halvings - 1) +
         simpson(f, m, b, fm, right_m, fb, right, 0.5 * tolerance, halvings - 1);
}

}  // namespace detail

/// Integral of f from a to b by adaptive Simpson rules, to about `relative` of the largest of |f| (b - a) on
/// 64 panels. f may have kinks and steep ends, no poles.
template <class Function>
double integral(const Function& f, double a, double b, double relative = 1e-11) {
  constexpr int panels = 64;
  const double h = (b - a) / panels;
  double largest = 0, sum = 0;
  for (int i = 0; i <= 2 * panels; ++i) largest = std::max(largest, std::abs(f(a + 0.5 * i * h)));
  const double tolerance = relative * largest * std::abs(h);
  for (int i = 0; i < panels; ++i) {
    const double x0 = a + i * h, x1 = x0 + h, f0 = f(x0), f1 = f(0.5 * (x0 + x1)), f2 = f(x1);
    sum += detail::simpson(f, x0, x1, f0, f1, f2, h / 6 * (f0 + 4 * f1 + f2), tolerance, 30);
  }
  return sum;
}

}  // namespace drumlin::continuum
