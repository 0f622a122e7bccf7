#pragma once
// Laws of the same form as numbers, one law after the other: how a band of laws is kept in a file.
#include <cstddef>
#include <vector>

#include "coupling/law/rheology_fit.hpp"

namespace drumlin {

/// Numbers that tell a draw of this law from the others; 0 of a form that is not fitted.
std::size_t draw_size(const MeasuredFriction& mu);
/// Those numbers: a, b; a, b, c; or mu of each I of the table.
std::vector<double> draw_of(const MeasuredFriction& mu);
/// The laws of the form of `mu` that `numbers` hold; what is left over is dropped.
std::vector<MeasuredFriction> draws_of(const MeasuredFriction& mu, const std::vector<double>& numbers);

}  // namespace drumlin
