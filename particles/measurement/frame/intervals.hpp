#pragma once
// 99 % intervals of averages over time-correlated samples: contiguous batches, delete-one jackknife over
// them.
#include <cstddef>
#include <span>

namespace drumlin::particles {

/// Which of `batches` contiguous batches of almost equal length sample `index` of `count` belongs to.
std::size_t batch_of(std::size_t index, std::size_t count, std::size_t batches);

/// Half widths of 99 % intervals per standard error, for `batches` batches: Student's t for half as many,
/// since the correlation of neighbours is estimated from them too. At least two batches.
double interval_factor(std::size_t batches);

/// Half width of the 99 % interval from the values e_b of an estimate with one batch left out each, in order
/// of time: interval_factor(B) sqrt((B - 1)/B (sum e_b'^2 + 2 max(0, sum e_b' e_(b+1)'))), ' counted from the
/// mean. For a plain mean over equal batches this is the method of batch means with the correlation of
/// neighbouring batches added; unlike it, it stays right for ratios and fits. NaN with fewer than two values
/// or when one of them is not finite.
double jackknife_ci99(std::span<const double> leave_one_out);

/// Half width for the mean of a series in order of time, over `batches` batches of it.
double mean_ci99(std::span<const double> series, std::size_t batches = 20);

}  // namespace drumlin::particles
