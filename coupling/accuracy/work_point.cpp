#include "coupling/accuracy/work_point.hpp"

#include <algorithm>
#include <cmath>

#include "coupling/accuracy/pareto.hpp"

namespace drumlin::coupling {

double number_named(const NamedNumbers& numbers, const std::string& name) {
  for (const auto& [known, value] : numbers)
    if (known == name) return value;
  return NAN;
}

std::vector<std::vector<std::string>> fronts(std::span<const WorkPoint> points,
                                             const std::vector<std::string>& quantities) {
  std::vector<std::vector<std::string>> stands_on(points.size());
  for (const std::string& quantity : quantities) {
    std::vector<double> seconds, errors;
    for (const WorkPoint& point : points) {
      seconds.push_back(point.cpu_seconds);
      errors.push_back(number_named(point.errors, quantity));
    }
    const std::vector<bool> front = pareto_front(seconds, errors);
    for (std::size_t i = 0; i < front.size(); ++i)
      if (front[i]) stands_on[i].push_back(quantity);
  }
  return stands_on;
}

Spread spread(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return {values.front(), values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2};
}

}  // namespace drumlin::coupling
