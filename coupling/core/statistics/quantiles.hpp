#pragma once
// Quantiles that turn standard errors into 99 % intervals (docs/theory/statistics.md).

namespace drumlin::statistics {

/// Half width of a two-sided 99 % interval per standard error that is known: P(|x| <= value) = 0.99 for a
/// normal distribution of variance 1.
inline constexpr double normal_quantile_99 = 2.5758293035489;

/// The same where the standard error is itself estimated, with so many degrees of freedom: P(|t| <= value) =
/// 0.99 for Student's t. 63.66 for one, 9.92 for two, 2.58 for many. Needs at least one.
double student_quantile_99(int degrees_of_freedom);

/// Half width of a 99 % interval per standard error that was told, where so many degrees of freedom of
/// scatter give `reduced_chi2` = chi^2/degrees_of_freedom in the units of what was told: the larger of
/// normal_quantile_99 and Student's t times sqrt(reduced_chi2). The first is right where the told error is,
/// the second whatever it is, so that the interval covers 99 % or more either way (the longer of both, as in
/// Wiksten, Ruecker & Schwarzer, Stat. Med. 35 (2016) 2503). Without degrees of freedom the first.
double quantile_99_of_stated_errors(double reduced_chi2, int degrees_of_freedom);

}  // namespace drumlin::statistics
