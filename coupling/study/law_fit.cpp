#include "coupling/study/law_fit.hpp"

#include <algorithm>
#include <cmath>

#include "coupling/statistics/quantiles.hpp"
#include "coupling/statistics/straight_line.hpp"

namespace drumlin::coupling {
namespace {

using statistics::StraightLine;

double squared_error(double ci99) {
  return std::isfinite(ci99) ? std::pow(ci99 / statistics::normal_quantile_99, 2) : 0;
}

/// Points that can be used together: where some carry an interval, those without would count as exact.
std::vector<LawPoint> usable(const std::vector<LawPoint>& points) {
  std::vector<LawPoint> finite;
  for (const LawPoint& point : points)
    if (std::isfinite(point.x) && std::isfinite(point.y)) finite.push_back(point);
  const auto known = [](const LawPoint& point) { return point.y_ci99 > 0; };
  if (std::any_of(finite.begin(), finite.end(), known))
    std::erase_if(finite, [&](const LawPoint& point) { return !known(point); });
  return finite;
}

struct Columns {
  std::vector<double> x, y;
};

Columns columns_of(const std::vector<LawPoint>& points) {
  Columns columns;
  for (const LawPoint& point : points) {
    columns.x.push_back(point.x);
    columns.y.push_back(point.y);
  }
  return columns;
}

std::vector<double> variances(const std::vector<LawPoint>& points, double slope) {
  std::vector<double> result;
  for (const LawPoint& point : points) {
    const double variance = squared_error(point.y_ci99) + slope * slope * squared_error(point.x_ci99);
    result.push_back(variance > 0 ? variance : 1.0);
  }
  return result;
}

double rms_about(const Columns& points, const StraightLine& line) {
  double squares = 0;
  for (std::size_t i = 0; i < points.x.size(); ++i)
    squares += std::pow(points.y[i] - line.intercept - line.slope * points.x[i], 2);
  return std::sqrt(squares / static_cast<double>(points.x.size()));
}

LawFit fitted(const std::vector<LawPoint>& given, bool with_offset) {
  const std::vector<LawPoint> points = usable(given);
  LawFit fit;
  fit.points = points.size();
  fit.coefficients.resize(with_offset ? 2 : 1);
  if (points.size() < fit.coefficients.size()) return fit;
  const bool told = points.front().y_ci99 > 0;
  const Columns columns = columns_of(points);
  const auto line_through = [&](const std::vector<double>& variance) {
    return with_offset ? statistics::fit_line(columns.x, columns.y, variance)
                       : statistics::fit_proportional(columns.x, columns.y, variance);
  };
  auto line = line_through(std::vector<double>(points.size(), 1.0));
  for (int round = 0; line && round < 20; ++round)  // the weights depend on the slope, weakly
    line = line_through(variances(points, told ? line->slope : 0));
  if (!line) return fit;
  fit.rms = rms_about(columns, *line);
  if (told) fit.reduced_chi2 = line->reduced_chi_squared();
  const double factor =
      interval_factor_99(*line, told ? statistics::Variances::told : statistics::Variances::relative);
  if (with_offset) fit.coefficients[0] = {line->intercept, factor * std::sqrt(line->var_intercept)};
  fit.coefficients.back() = {line->slope, factor * std::sqrt(line->var_slope)};
  return fit;
}

}  // namespace

LawFit fit_proportional(const std::vector<LawPoint>& points) { return fitted(points, false); }

LawFit fit_line(const std::vector<LawPoint>& points) { return fitted(points, true); }

LawFit fit_power(const std::vector<LawPoint>& points) {
  std::vector<LawPoint> logarithms;
  for (const LawPoint& point : points)
    if (point.x > 0 && point.y > 0)
      logarithms.push_back(
          {std::log(point.x), std::log(point.y), point.x_ci99 / point.x, point.y_ci99 / point.y});
  LawFit fit = fitted(logarithms, true);
  auto& scale = fit.coefficients[0];
  scale.value = std::exp(scale.value);
  scale.ci99 *= scale.value;
  return fit;
}

}  // namespace drumlin::coupling
