#pragma once
// A fitted law with the laws of other draws of its points.
#include <functional>
#include <vector>

#include "coupling/calibration/robust_law.hpp"

namespace drumlin::coupling {

struct CalibratedLaw {
  FrictionForm form;
  RobustFriction fit;
  std::vector<Coefficients> draws;
  double I_min = 0, I_max = 0;  ///< of its points: where it is valid

  FormCurve curve() const { return {form, fit.law}; }
  BandOfDraws band() const { return {form, draws}; }
};

/// A table of mu is well-posed (well_posed_form()) at each of its I. Throws InputError as
/// fit_friction(). `before_each` draw, if there is one, is called.
CalibratedLaw calibrated(const std::vector<std::vector<FrictionPoint>>& runs, const FrictionForm& form,
                         int draws, const std::function<void()>& before_each = {});

/// The law and its 99 % band at inertial numbers that are evenly spaced in ln I over its range.
struct SampledLaw {
  std::vector<double> I, value, low, high;
};
SampledLaw sampled(const CalibratedLaw& law, int intervals = 60);

/// Between what each coefficient lies in 99 % of the draws.
std::vector<FrictionBand> coefficient_ranges(const CalibratedLaw& law);

/// Half width of the 99 % band at I.
double half_width_at(const CalibratedLaw& law, double I);

/// The points of all runs, one after the other.
std::vector<FrictionPoint> all_of(const std::vector<std::vector<FrictionPoint>>& runs);

}  // namespace drumlin::coupling
