#pragma once
// A point of a work-precision diagram: what it costs, and its errors by name.
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace drumlin::coupling {

/// Numbers by name, in a fixed order; NaN: not known.
using NamedNumbers = std::vector<std::pair<std::string, double>>;

/// The number of this name, NaN if there is none.
double number_named(const NamedNumbers& numbers, const std::string& name);

struct WorkPoint {
  double cpu_seconds = 0;  ///< NaN: it did not converge
  NamedNumbers errors;     ///< relative, by quantity
};

/// For each point the quantities on whose front it stands (`pareto_front`): least error for its seconds.
/// A point without a number for a quantity is never on its front.
std::vector<std::vector<std::string>> fronts(std::span<const WorkPoint> points,
                                             const std::vector<std::string>& quantities);

/// Of repetitions of the same work.
struct Spread {
  double least = 0, median = 0;
};
/// `values` holds one at least; the median of an even number is the mean of the middle two.
Spread spread(std::vector<double> values);

}  // namespace drumlin::coupling
