#pragma once
// Errors of estimates from their own samples: leaving out one part at a time, and drawing anew.
#include <cstddef>
#include <random>
#include <span>
#include <vector>

namespace drumlin::statistics {

/// Variance of an estimate from its values e_b with one of n parts left out each, in order of time: (n - 1)/n
/// (sum e_b'^2 + 2 max(0, sum e_b' e_(b+1)')), ' counted from their mean: the jackknife (Efron & Tibshirani,
/// An Introduction to the Bootstrap, 1993, ch. 11) with the correlation of neighbouring parts where it is
/// positive. Of a plain mean over parts that are not correlated it is the square of its standard error. NaN
/// with fewer than two values or when one is not finite.
double jackknife_variance(std::span<const double> leave_one_out);

/// One draw of the block bootstrap: `count` indices in 0 .. count - 1, blocks of `block_length` consecutive
/// ones (the last may be shorter) that begin anywhere and go round at the end (Politis & Romano 1992,
/// circular blocks). The same generator gives the same indices with every standard library. count > 0.
std::vector<std::size_t> block_draw(std::size_t count, std::size_t block_length, std::mt19937_64& random);

}  // namespace drumlin::statistics
