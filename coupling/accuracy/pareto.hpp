#pragma once
// The Pareto front of a work-precision diagram: the points that no other beats in cost and error.
#include <span>
#include <vector>

namespace drumlin::coupling {

/// True for every point that no other beats: none has at most its cost and at most its error, and less of one
/// of them. A point with a number that is not finite is never on the front. Both spans are of one length.
std::vector<bool> pareto_front(std::span<const double> cost, std::span<const double> error);

}  // namespace drumlin::coupling
