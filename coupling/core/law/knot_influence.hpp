#pragma once
// How a monotone cubic moves with the values at its knots: what a fit of those values needs.
#include <array>
#include <span>
#include <vector>

#include "coupling/core/law/monotone_cubic.hpp"

namespace drumlin {

/// Derivatives of MonotoneCubic(x, y, outside).at(.).value by each y. The limiter of the slopes makes the
/// curve a piecewise linear function of y; where two pieces meet, those of one of them.
class KnotInfluence {
 public:
  /// As MonotoneCubic.
  KnotInfluence(std::vector<double> x, const std::vector<double>& y, MonotoneCubic::Outside outside);
  /// `by_knot`, one entry for each knot, receives the derivatives at `at`; their sum is 1.
  void at(double at, std::span<double> by_knot) const;

 private:
  // Derivatives of the slope at a knot by the y before it, its own and the y after it.
  using OfSlope = std::array<double, 3>;
  void add_slope(std::size_t knot, double factor, std::span<double> by_knot) const;
  std::vector<double> x_;
  std::vector<OfSlope> slope_;
};

}  // namespace drumlin
