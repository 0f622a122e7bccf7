#pragma once
// k(I) = sigma_xx/sigma_zz, and the inertial number that belongs to it.
#include <vector>

#include "coupling/core/law/monotone_cubic.hpp"
#include "coupling/core/law/rheology_fit.hpp"

namespace drumlin {

/// k over ln I through the points of a table: MonotoneCubic between them, constant outside.
class StressRatioLaw {
 public:
  /// I ascending, k positive with dk/dln I < 1 + k between neighbours, so that one rate has one inertial
  /// number.
  StressRatioLaw(const std::vector<double>& I, std::vector<double> k);
  /// k and dk/dln I.
  CurvePoint at_ln(double ln_I) const { return k_.at(ln_I); }
  double smallest() const { return smallest_; }
  double largest() const { return largest_; }

 private:
  MonotoneCubic k_;
  double smallest_ = 0, largest_ = 0;  // of k at any I
};

/// What evaluates the k of a file (or of a calibration).
StressRatioLaw stress_ratio_law(const NormalStressRatio& points);

/// Inertial number and ratio of the normal stresses at a point.
struct ShearState {
  double I = 0;
  double k = 0;
  double k_slope = 0;  ///< dk/dln I
};

/// The state that solves I = 2|D|/sqrt(sigma_zz), sigma_zz = 2p/(1 + k(I)): I stands on both sides. Newton's
/// method kept inside a bracket that shrinks at every step; the equation has one solution.
ShearState shear_state(const StressRatioLaw& law, double rate, double pressure);

}  // namespace drumlin
