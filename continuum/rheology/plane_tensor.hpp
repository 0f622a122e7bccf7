#pragma once
// Symmetric tensors in the plane (x, z), as the laws see them.
#include <cmath>

namespace drumlin::continuum {

/// Symmetric 2 x 2 tensor: strain rate (1/sqrt(d/g)) or stress (rho0 g d).
struct PlaneTensor {
  double xx = 0;
  double zz = 0;
  double xz = 0;
};

inline PlaneTensor operator+(const PlaneTensor& a, const PlaneTensor& b) {
  return {a.xx + b.xx, a.zz + b.zz, a.xz + b.xz};
}
inline PlaneTensor operator-(const PlaneTensor& a, const PlaneTensor& b) {
  return {a.xx - b.xx, a.zz - b.zz, a.xz - b.xz};
}
inline PlaneTensor operator*(double s, const PlaneTensor& a) { return {s * a.xx, s * a.zz, s * a.xz}; }

/// A:B.
inline double contraction(const PlaneTensor& a, const PlaneTensor& b) {
  return a.xx * b.xx + a.zz * b.zz + 2 * a.xz * b.xz;
}
/// |A| = sqrt(A:A/2): in simple shear |D| is half the shear rate.
inline double magnitude(const PlaneTensor& a) { return std::sqrt(0.5 * contraction(a, a)); }

}  // namespace drumlin::continuum
