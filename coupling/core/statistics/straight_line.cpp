#include "coupling/core/statistics/straight_line.hpp"

#include <cassert>
#include <cmath>
#include <limits>
#include <vector>

#include "coupling/core/statistics/quantiles.hpp"
#include "coupling/core/statistics/samples.hpp"

namespace drumlin::statistics {
namespace {

struct Points {
  std::span<const double> x, y, variance;
};

void add_scatter(const Points& points, StraightLine& line) {
  for (std::size_t i = 0; i < points.x.size(); ++i) {
    const double residual = points.y[i] - line.intercept - line.slope * points.x[i];
    line.chi_squared += residual * residual / points.variance[i];
  }
  line.points = points.x.size();
  line.degrees_of_freedom = static_cast<int>(points.x.size()) - 2;
}

/// About the weighted means of x and y, so that a large mean costs no digits.
std::optional<StraightLine> fit_about(double mean_x, double mean_y, double var_mean, const Points& points) {
  double sxx = 0, sxy = 0;
  for (std::size_t i = 0; i < points.x.size(); ++i) {
    const double x = points.x[i] - mean_x;
    sxx += x * x / points.variance[i];
    sxy += x * (points.y[i] - mean_y) / points.variance[i];
  }
  if (!(sxx > 0)) return std::nullopt;
  StraightLine line;
  line.slope = sxy / sxx;
  line.intercept = mean_y - line.slope * mean_x;
  line.var_slope = 1 / sxx;
  line.var_intercept = var_mean + mean_x * mean_x / sxx;
  line.covariance = -mean_x / sxx;
  add_scatter(points, line);
  return line;
}

}  // namespace

double StraightLine::reduced_chi_squared() const {
  return degrees_of_freedom > 0 ? chi_squared / degrees_of_freedom : std::numeric_limits<double>::quiet_NaN();
}

double interval_factor_99(const StraightLine& line, Variances variances) {
  const double scatter = line.reduced_chi_squared();
  switch (variances) {
    case Variances::known:
      return normal_quantile_99;
    case Variances::relative:
      return line.degrees_of_freedom > 0 ? student_quantile_99(line.degrees_of_freedom) * std::sqrt(scatter)
                                         : std::numeric_limits<double>::quiet_NaN();
    case Variances::stated:
      return quantile_99_of_stated_errors(scatter, line.degrees_of_freedom);
  }
  return std::numeric_limits<double>::quiet_NaN();
}

std::optional<StraightLine> fit_line(std::span<const double> x, std::span<const double> y) {
  assert(x.size() == y.size());
  if (x.size() < 2) return std::nullopt;
  const std::vector<double> variance(x.size(), 1.0);
  return fit_about(mean(x), mean(y), 1 / static_cast<double>(x.size()), {x, y, variance});
}

std::optional<StraightLine> fit_line(std::span<const double> x, std::span<const double> y,
                                     std::span<const double> variance) {
  assert(x.size() == y.size() && x.size() == variance.size());
  if (x.size() < 2) return std::nullopt;
  const WeightedMean middle_x = weighted_mean(x, variance), middle_y = weighted_mean(y, variance);
  return fit_about(middle_x.value, middle_y.value, middle_x.variance, {x, y, variance});
}

}  // namespace drumlin::statistics
