#include "coupling/study/law_fit.hpp"

#include <algorithm>
#include <cmath>

#include "coupling/exchange/student.hpp"

namespace drumlin {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

double squared_error(double ci99) { return std::isfinite(ci99) ? std::pow(ci99 / normal_quantile_99, 2) : 0; }

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

/// y = c0 + c1 x, or without c0.
struct Solution {
  double c0 = 0, c1 = 0;
  double var_c0 = 0, var_c1 = 0;
};

Solution weighted(const std::vector<LawPoint>& points, const std::vector<double>& weight, bool with_offset) {
  double w = 0, mean_x = 0, mean_y = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    w += weight[i];
    mean_x += weight[i] * points[i].x;
    mean_y += weight[i] * points[i].y;
  }
  mean_x = with_offset ? mean_x / w : 0;
  mean_y = with_offset ? mean_y / w : 0;
  double sxx = 0, sxy = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double x = points[i].x - mean_x;
    sxx += weight[i] * x * x;
    sxy += weight[i] * x * (points[i].y - mean_y);
  }
  Solution solution;
  solution.c1 = sxy / sxx;
  solution.var_c1 = 1 / sxx;
  if (!with_offset) return solution;
  solution.c0 = mean_y - solution.c1 * mean_x;
  solution.var_c0 = 1 / w + mean_x * mean_x / sxx;
  return solution;
}

std::vector<double> weights(const std::vector<LawPoint>& points, double slope) {
  std::vector<double> weight;
  for (const LawPoint& point : points) {
    const double variance = squared_error(point.y_ci99) + slope * slope * squared_error(point.x_ci99);
    weight.push_back(variance > 0 ? 1 / variance : 1.0);
  }
  return weight;
}

double residual(const LawPoint& point, const Solution& solution) {
  return point.y - solution.c0 - solution.c1 * point.x;
}

LawFit fitted(const std::vector<LawPoint>& given, bool with_offset) {
  const std::vector<LawPoint> points = usable(given);
  const std::size_t count = with_offset ? 2 : 1;
  LawFit fit;
  fit.points = points.size();
  fit.coefficients.resize(count);
  if (points.size() < count) return fit;
  const bool known = points.front().y_ci99 > 0;

  Solution solution = weighted(points, std::vector<double>(points.size(), 1.0), with_offset);
  std::vector<double> weight;
  for (int round = 0; round < 20; ++round) {  // the weights depend on the slope, weakly
    weight = weights(points, known ? solution.c1 : 0);
    solution = weighted(points, weight, with_offset);
  }
  double chi2 = 0, squares = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    chi2 += weight[i] * std::pow(residual(points[i], solution), 2);
    squares += std::pow(residual(points[i], solution), 2);
  }
  const auto freedom = static_cast<int>(points.size() - count);
  fit.rms = std::sqrt(squares / static_cast<double>(points.size()));
  const double reduced = freedom > 0 ? chi2 / freedom : nan;
  if (known) fit.reduced_chi2 = reduced;
  double factor = known ? normal_quantile_99 : nan;
  if (freedom > 0) factor = std::fmax(factor, student_quantile_99(freedom) * std::sqrt(reduced));
  const LawFit::Coefficient slope{solution.c1, factor * std::sqrt(solution.var_c1)};
  if (with_offset)
    fit.coefficients = {{solution.c0, factor * std::sqrt(solution.var_c0)}, slope};
  else
    fit.coefficients = {slope};
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

}  // namespace drumlin
