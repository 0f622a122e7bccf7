#pragma once
// Weighted fits of one- and two-coefficient laws, with 99 % intervals on the coefficients.
#include <cstddef>
#include <limits>
#include <vector>

namespace drumlin::coupling {

/// A measured pair; half widths of 99 % intervals, NaN where there is none.
struct LawPoint {
  double x = 0;
  double y = 0;
  double x_ci99 = std::numeric_limits<double>::quiet_NaN();
  double y_ci99 = std::numeric_limits<double>::quiet_NaN();
};

struct LawFit {
  struct Coefficient {
    double value = std::numeric_limits<double>::quiet_NaN();
    double ci99 = std::numeric_limits<double>::quiet_NaN();
  };
  std::vector<Coefficient> coefficients;
  double reduced_chi2 = std::numeric_limits<double>::quiet_NaN();  ///< NaN where no point has an interval
  double rms = std::numeric_limits<double>::quiet_NaN();           ///< of y about the law, unweighted
  std::size_t points = 0;  ///< used: x and y finite, and an interval if any of them has one
};

/// y = c x. Coefficients: c.
LawFit fit_proportional(const std::vector<LawPoint>& points);

/// y = c0 + c1 x. Coefficients: c0, c1.
LawFit fit_line(const std::vector<LawPoint>& points);

/// y = c x^p by the line through the logarithms. Coefficients: c, p; rms is that of ln y. Points with x or y
/// <= 0 are left out.
LawFit fit_power(const std::vector<LawPoint>& points);

// Weights are 1/(s_y^2 + (y' s_x)^2) with s = ci99 / 2.576 and y' the slope of the law ("effective variance":
// Orear, Am. J. Phys. 50 (1982) 912). The half width of a coefficient is the larger of 2.576 standard errors
// that follow from the points' intervals, and Student's t (points - coefficients degrees of freedom) times
// those that follow from the scatter about the law: the first is right when the law holds within the
// intervals, the second when it does not. With fewer points than coefficients nothing is fitted (NaN); with
// as many the scatter says nothing.

}  // namespace drumlin::coupling
