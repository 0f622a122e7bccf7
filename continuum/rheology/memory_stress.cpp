#include "continuum/rheology/memory_stress.hpp"

#include <algorithm>

#include "coupling/core/law/well_posedness.hpp"

namespace drumlin::continuum {

double well_posedness_margin(const MemoryResponse& s) {
  const std::complex<double> n = as_complex(s.right);
  const double size = std::abs(n);
  const std::complex<double> to_axes = size > 0 ? std::conj(n) / size : 1;
  const std::complex<double> A = as_complex(s.memory) * to_axes;
  const double by_pressure = s.strength.d_pressure / s.rho, r = s.rate * s.strength.d_rate / s.strength.value;
  const std::complex<double> whole = size + s.weight * A, by_rate = r * whole - size + s.weight_slope * A;
  if (std::abs(by_pressure) * std::abs(whole) >= 1) return -1;
  CircleForm form;
  form.constant = 1;
  form.x = -by_pressure * whole.real();
  form.y = by_pressure * (whole.imag() + size * (whole * std::conj(by_rate)).imag());
  form.yy = size * by_rate.real();
  form.xy = 0.5 * size * by_rate.imag();
  return minimum_on_circle(form);
}

double rho_target(double m, std::complex<double> n, std::complex<double> A) {
  const double weight = m * std::norm(n);
  const double square = 1 + 2 * weight * (n * std::conj(A)).real() + weight * weight * std::norm(A);
  return std::max(least_rho, std::sqrt(std::max(0.0, square)));
}

}  // namespace drumlin::continuum
