#pragma once
// What turns standard errors into 99 % intervals.

namespace drumlin {

/// Half width of a 99 % interval per standard error of a normal distribution.
inline constexpr double normal_quantile_99 = 2.5758293035489;

/// Two-sided 99 % quantile of Student's t: P(|t| <= value) = 0.99. Needs at least one degree of freedom.
double student_quantile_99(int degrees_of_freedom);

/// Value that chi^2 stays below with a probability of 99 %, by Wilson and Hilferty (Proc. Natl. Acad. Sci. 17
/// (1931) 684): to 1 % from three degrees of freedom on, 3 % for one. Needs at least one.
double chi_squared_quantile_99(int degrees_of_freedom);

}  // namespace drumlin
