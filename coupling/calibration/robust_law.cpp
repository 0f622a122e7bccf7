#include "coupling/calibration/robust_law.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "coupling/exchange/errors.hpp"
#include "coupling/exchange/student.hpp"

namespace drumlin {
namespace {

constexpr double bend = 1.5;       // Huber's k
constexpr double kept = 0.778474;  // mean of min(z^2, k^2) of a normal z
constexpr int block_length = 4;
// Points exactly on a law have no scatter, yet their weights must stay finite.
constexpr double least_scatter_squared = 1e-24;

double known(double error) { return std::isfinite(error) ? error : 0; }

double residual(const FrictionPoint& point, const FrictionCoefficients& law) {
  return point.mu - friction(law, point.I);
}

double variance(const FrictionPoint& point, const FrictionCoefficients& law, double scatter_squared) {
  const double slope = law.b + law.c * point.I;  // I dmu/dI
  return std::pow(known(point.mu_error), 2) + std::pow(slope * known(point.I_error) / point.I, 2) +
         scatter_squared;
}

FrictionCoefficients weighted_law(const std::vector<FrictionPoint>& points, const std::vector<double>& weight,
                                  bool with_log, bool with_linear) {
  const Eigen::Index columns = 1 + (with_log ? 1 : 0) + (with_linear ? 1 : 0);
  const auto rows = static_cast<Eigen::Index>(points.size());
  Eigen::MatrixXd design(rows, columns);
  Eigen::VectorXd value(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const FrictionPoint& point = points[static_cast<std::size_t>(i)];
    const double w = std::sqrt(weight[static_cast<std::size_t>(i)]);
    Eigen::Index column = 0;
    design(i, column++) = w;
    if (with_log) design(i, column++) = w * std::log(point.I);
    if (with_linear) design(i, column++) = w * point.I;
    value(i) = w * point.mu;
  }
  const Eigen::VectorXd found = design.colPivHouseholderQr().solve(value);
  FrictionCoefficients law{.a = found(0)};
  if (with_log) law.b = found(1);
  if (with_linear) law.c = found(columns - 1);
  return law;
}

FrictionCoefficients growing_law(const std::vector<FrictionPoint>& points, const std::vector<double>& weight,
                                 FrictionForm form) {
  FrictionCoefficients law = weighted_law(points, weight, true, form == FrictionForm::log_linear);
  if (law.c < 0) law = weighted_law(points, weight, true, false);
  if (law.b < 0) law = weighted_law(points, weight, false, form == FrictionForm::log_linear);
  if (law.b == 0 && law.c < 0) law = weighted_law(points, weight, false, false);
  return law;
}

// Law for a given scatter; its weights depend on the law.
FrictionCoefficients law_with_scatter(const std::vector<FrictionPoint>& points, FrictionForm form,
                                      FrictionCoefficients law, double scatter_squared) {
  std::vector<double> weight(points.size());
  for (int round = 0; round < 15; ++round) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double v = variance(points[i], law, scatter_squared);
      const double off = std::abs(residual(points[i], law)) / std::sqrt(v);
      weight[i] = std::min(1.0, bend / std::max(off, 1e-300)) / v;
    }
    law = growing_law(points, weight, form);
  }
  return law;
}

// Mean of the bounded squares over what it would be if the variances were right.
double excess(const std::vector<FrictionPoint>& points, FrictionForm form, const FrictionCoefficients& law,
              double scatter_squared) {
  double sum = 0;
  for (const FrictionPoint& point : points)
    sum += std::min(std::pow(residual(point, law), 2) / variance(point, law, scatter_squared), bend * bend);
  const double freedom = static_cast<double>(points.size()) - (form == FrictionForm::log ? 2 : 3);
  return sum / (kept * freedom);
}

void check(const std::vector<FrictionPoint>& points, FrictionForm form) {
  const std::size_t least = form == FrictionForm::log ? 3 : 4;
  if (points.size() < least)
    throw InputError("mu(I) needs at least " + std::to_string(least) +
                     " layers within the range of I, there are " + std::to_string(points.size()));
  const auto [low, high] = std::minmax_element(points.begin(), points.end(),
                                               [](const auto& p, const auto& q) { return p.I < q.I; });
  if (!(low->I > 0) || !(low->I < high->I)) throw InputError("mu(I) needs layers of different positive I");
}

// Draws of few blocks differ by less than new measurements would: n/(n - coefficients) of the variance, and
// Student's t.
double small_sample_factor(std::size_t points, int coefficients) {
  const int blocks = static_cast<int>(points) / block_length;
  const int freedom = std::max(1, blocks - coefficients);
  return std::sqrt(static_cast<double>(std::max(blocks, 1)) / freedom) * student_quantile_99(freedom) /
         normal_quantile_99;
}

// 0 .. count - 1; the library's distributions may differ from one standard library to the next.
std::size_t drawn(std::mt19937_64& random, std::size_t count) { return random() % count; }

std::vector<FrictionPoint> redrawn(const std::vector<FrictionPoint>& run, std::mt19937_64& random) {
  std::vector<FrictionPoint> draw;
  while (draw.size() < run.size()) {
    const std::size_t first = drawn(random, run.size());
    for (std::size_t k = 0; k < block_length && draw.size() < run.size(); ++k)
      draw.push_back(run[(first + k) % run.size()]);
  }
  return draw;
}

}  // namespace

double friction(const FrictionCoefficients& law, double I) { return law.a + law.b * std::log(I) + law.c * I; }

RobustFriction fit_friction(const std::vector<FrictionPoint>& points, FrictionForm form) {
  check(points, form);
  const FrictionCoefficients plain = growing_law(points, std::vector<double>(points.size(), 1.0), form);
  double squares = 0;
  for (const FrictionPoint& point : points) squares += std::pow(residual(point, plain), 2);

  double low = least_scatter_squared, high = std::max(2 * low, 4 * squares);
  FrictionCoefficients law = law_with_scatter(points, form, plain, low);
  double s2 = low;
  if (excess(points, form, law, low) > 1) {
    for (int halving = 0; halving < 60; ++halving) {
      s2 = std::sqrt(low * high);
      law = law_with_scatter(points, form, plain, s2);
      (excess(points, form, law, s2) > 1 ? low : high) = s2;
    }
  }
  RobustFriction fit{
      .law = law, .intrinsic_scatter = s2 > 1e-23 ? std::sqrt(s2) : 0, .points = points.size()};
  double sum = 0, outliers = 0;
  for (const FrictionPoint& point : points) {
    const double off = residual(point, law);
    sum += off * off;
    if (std::abs(off) > bend * std::sqrt(variance(point, law, s2))) ++outliers;
  }
  fit.rms_misfit = std::sqrt(sum / static_cast<double>(points.size()));
  fit.outlier_share = outliers / static_cast<double>(points.size());
  return fit;
}

std::vector<FrictionCoefficients> bootstrapped(const std::vector<std::vector<FrictionPoint>>& runs,
                                               FrictionForm form, int replicates, std::uint64_t seed) {
  std::vector<FrictionPoint> all;
  for (const auto& run : runs) all.insert(all.end(), run.begin(), run.end());
  const RobustFriction fit = fit_friction(all, form);
  const double s2 = std::max(least_scatter_squared, fit.intrinsic_scatter * fit.intrinsic_scatter);
  const double widening = small_sample_factor(all.size(), form == FrictionForm::log ? 2 : 3);

  std::mt19937_64 random(seed);
  std::vector<FrictionCoefficients> laws;
  for (int replicate = 0; replicate < replicates; ++replicate) {
    std::vector<FrictionPoint> points;
    for (const auto& run : runs) {
      if (run.empty()) continue;
      const auto draw = redrawn(run, random);
      points.insert(points.end(), draw.begin(), draw.end());
    }
    const FrictionCoefficients one = law_with_scatter(points, form, fit.law, s2);
    const auto widened = [&](double value, double centre) { return centre + widening * (value - centre); };
    laws.push_back({widened(one.a, fit.law.a), std::max(0.0, widened(one.b, fit.law.b)),
                    std::max(0.0, widened(one.c, fit.law.c))});
  }
  return laws;
}

FrictionBand band_at(const std::vector<FrictionCoefficients>& laws, double I, double share) {
  std::vector<double> values;
  for (const FrictionCoefficients& law : laws) values.push_back(friction(law, I));
  std::sort(values.begin(), values.end());
  const auto at = [&](double quantile) {
    const double place = quantile * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, values.size() - 1);
    return values[below] + (place - static_cast<double>(below)) * (values[above] - values[below]);
  };
  return {at(0.5 * (1 - share)), at(0.5 * (1 + share))};
}

}  // namespace drumlin
