#pragma once
// 99 % intervals of averages over time-correlated samples: contiguous batches, delete-one jackknife over
// them.
#include <cstddef>
#include <span>

namespace drumlin {

/// Two-sided 99 % quantile of Student's t: P(|t| <= value) = 0.99. Needs at least one degree of freedom.
double student_quantile_99(int degrees_of_freedom);

/// Which of `batches` contiguous batches of almost equal length sample `index` of `count` belongs to.
std::size_t batch_of(std::size_t index, std::size_t count, std::size_t batches);

/// Half width of the 99 % interval from the values of an estimate with one batch left out each:
/// t_99(B - 1) sqrt((B - 1)/B sum (e_b - mean)^2). For a plain mean over equal batches this is the method of
/// batch means; unlike it, it stays right for ratios and fits. The batches must be longer than the
/// correlation time. NaN with fewer than two values or when one of them is not finite.
double jackknife_ci99(std::span<const double> leave_one_out);

/// Half width for the mean of a series in order of time, over `batches` batches of it.
double mean_ci99(std::span<const double> series, std::size_t batches = 20);

}  // namespace drumlin
