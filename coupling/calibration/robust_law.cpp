#include "coupling/calibration/robust_law.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <string>

#include "coupling/calibration/bounded_least_squares.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/statistics/quantiles.hpp"
#include "coupling/core/statistics/resampling.hpp"

namespace drumlin::coupling {
namespace {

constexpr double huber = 1.5;              // Huber's k
constexpr double mean_clipped = 0.778474;  // mean of min(z^2, k^2) of a normal z
constexpr int block_length = 4;
// Points exactly on a law have no scatter, yet their weights must stay finite.
constexpr double least_scatter_squared = 1e-24;

using Points = std::vector<FrictionPoint>;
using Weights = std::vector<double>;

double residual(const FrictionPoint& point, const FormCurve& curve) {
  return point.mu - curve.at(point.I).value;
}

double variance(const FrictionPoint& point, double slope, double scatter_squared) {
  return std::pow(known(point.mu_error), 2) + std::pow(slope * known(point.I_error) / point.I, 2) +
         scatter_squared;
}

// A draw may leave an interval of the table without points. That neighbouring intervals are equally steep
// then decides, with the weight of a hundredth of a point. Rows that ask for nought, each with its interval.
std::vector<std::vector<double>> bends_of(const FrictionForm& form) {
  std::vector<std::vector<double>> rows;
  const auto width = [&](std::size_t k) { return std::log(form.knots[k] / form.knots[k - 1]); };
  for (std::size_t j = 1; j + 1 < form.knots.size(); ++j) {
    const double span = 0.5 * (width(j) + width(j + 1));
    std::vector<double> row(form.size(), 0.0);
    row[j] = span / width(j);
    row[j + 1] = -span / width(j + 1);
    rows.push_back(std::move(row));
  }
  return rows;
}

// Weighted squares of the misfit, to be made small by steps of Gauss and Newton.
class WeightedFit {
 public:
  WeightedFit(const Points& points, const FrictionForm& form)
      : points_(points), form_(form), bends_(bends_of(form)), weight_(points.size(), 1.0) {
    for (std::size_t j = 0; j < form.size(); ++j) least_.push_back(least_coefficient(form, j));
  }
  void set_weights(Weights weight) {
    weight_ = std::move(weight);
    bend_weight_ =
        0.01 * std::accumulate(weight_.begin(), weight_.end(), 0.0) / static_cast<double>(weight_.size());
  }

  // The law one step on: exact for a form that is linear in its coefficients. The step is halved while it
  // would make the squares larger, as where the limiter of a table changes sides.
  Coefficients next(const Coefficients& law) const {
    const Coefficients whole = bounded_minimum(linearised(law), least_);
    const double before = squares(law);
    Coefficients trial = whole;
    for (double share = 1; share > 1e-3; share /= 2) {
      for (std::size_t j = 0; j < law.size(); ++j) trial[j] = law[j] + share * (whole[j] - law[j]);
      if (squares(trial) <= before) return trial;
    }
    return law;
  }

  // A law within the bounds from which the first step starts: mu (or k) as it is on average, growing a little
  // everywhere, so that no limiter acts.
  Coefficients start() const {
    Coefficients law(form_.size(), 0.01);
    for (std::size_t j = 1; j < form_.knots.size(); ++j)
      law[j] = std::max(least_[j], 0.01 * std::log(form_.knots[j] / form_.knots[j - 1]));
    double mean = 0;
    for (const FrictionPoint& point : points_) mean += point.mu / static_cast<double>(points_.size());
    law[0] = form_.kind == FormKind::turn ? 1 : mean;
    return law;
  }

 private:
  NormalEquations linearised(const Coefficients& law) const {
    const FormCurve curve(form_, law);
    NormalEquations equations(form_.size());
    std::vector<double> row(form_.size());
    for (std::size_t i = 0; i < points_.size(); ++i) {
      curve.influence(points_[i].I, row);
      const double tangent = std::inner_product(row.begin(), row.end(), law.begin(), 0.0);
      equations.add(weight_[i], row, residual(points_[i], curve) + tangent);
    }
    for (const auto& bend : bends_) equations.add(bend_weight_, bend, 0);
    return equations;
  }

  double squares(const Coefficients& law) const {
    const FormCurve curve(form_, law);
    double sum = 0;
    for (std::size_t i = 0; i < points_.size(); ++i)
      sum += weight_[i] * std::pow(residual(points_[i], curve), 2);
    for (const auto& bend : bends_)
      sum += bend_weight_ * std::pow(std::inner_product(bend.begin(), bend.end(), law.begin(), 0.0), 2);
    return sum;
  }

  const Points& points_;
  const FrictionForm& form_;
  std::vector<std::vector<double>> bends_;
  Coefficients least_;
  Weights weight_;
  double bend_weight_ = 0.01;
};

bool nearly_equal(const Coefficients& a, const Coefficients& b) {
  for (std::size_t j = 0; j < a.size(); ++j)
    if (std::abs(a[j] - b[j]) > 1e-10 * (std::abs(a[j]) + std::abs(b[j]))) return false;
  return true;
}

// Least squares with equal weights.
Coefficients plain_law(const Points& points, const FrictionForm& form) {
  const WeightedFit fit(points, form);
  Coefficients law = fit.start();
  for (int round = 0; round < 30; ++round) {
    const Coefficients next = fit.next(law);
    const bool done = nearly_equal(next, law);
    law = next;
    if (done) break;
  }
  return law;
}

// Law for a given scatter; its weights depend on the law.
Coefficients law_with_scatter(const Points& points, const FrictionForm& form, Coefficients law,
                              double scatter_squared) {
  WeightedFit fit(points, form);
  Weights weight(points.size());
  for (int round = 0; round < 15; ++round) {
    const FormCurve curve(form, law);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const CurvePoint at = curve.at(points[i].I);
      const double v = variance(points[i], at.slope, scatter_squared);
      const double off = std::abs(points[i].mu - at.value) / std::sqrt(v);
      weight[i] = std::min(1.0, huber / std::max(off, 1e-300)) / v;
    }
    fit.set_weights(weight);
    const Coefficients next = fit.next(law);
    const bool done = nearly_equal(next, law);
    law = next;
    if (done) break;
  }
  return law;
}

// Mean of the bounded squares over what it would be if the variances were right.
double excess(const Points& points, const FrictionForm& form, const Coefficients& law,
              double scatter_squared) {
  const FormCurve curve(form, law);
  double sum = 0;
  for (const FrictionPoint& point : points) {
    const CurvePoint at = curve.at(point.I);
    sum += std::min(std::pow(point.mu - at.value, 2) / variance(point, at.slope, scatter_squared),
                    huber * huber);
  }
  const double freedom = static_cast<double>(points.size()) - static_cast<double>(form.size());
  return sum / (mean_clipped * freedom);
}

void check(const std::vector<FrictionPoint>& points, const FrictionForm& form) {
  const std::size_t least = form.size() + 1;
  if (points.size() < least)
    throw InputError("mu(I) needs at least " + std::to_string(least) +
                     " layers within the range of I, there are " + std::to_string(points.size()));
  const auto [low, high] = std::minmax_element(points.begin(), points.end(),
                                               [](const auto& p, const auto& q) { return p.I < q.I; });
  if (!(low->I > 0) || !(low->I < high->I)) throw InputError("mu(I) needs layers of different positive I");
}

// Draws of few blocks differ by less than new measurements would: n/(n - coefficients) of the variance, and
// Student's t. Each run is one block at least.
double small_sample_factor(std::size_t points, std::size_t runs, int coefficients) {
  const int blocks = static_cast<int>(std::max(points / block_length, runs));
  const int freedom = std::max(1, blocks - coefficients);
  return std::sqrt(static_cast<double>(std::max(blocks, 1)) / freedom) *
         statistics::student_quantile_99(freedom) / statistics::normal_quantile_99;
}

/// Normal (Box and Muller), of the standard's generator: its distributions differ from one library to the
/// next.
double normal_draw(std::mt19937_64& random) {
  const auto uniform = [&] { return (static_cast<double>(random() >> 11) + 0.5) * 0x1p-53; };
  const double radius = std::sqrt(-2 * std::log(uniform()));
  return radius * std::cos(2 * std::numbers::pi * uniform());
}

bool is_short(const Points& run) { return run.size() < 2 * block_length; }

/// `widening`: of the misfit of a short run.
Points redrawn(const Points& run, const FormCurve& law, double widening, std::mt19937_64& random) {
  if (is_short(run)) {
    Points draw = run;
    const double share = widening * normal_draw(random);
    for (FrictionPoint& point : draw) point.mu -= (1 - share) * residual(point, law);
    return draw;
  }
  Points draw;
  for (const std::size_t i : statistics::block_draw(run.size(), block_length, random)) draw.push_back(run[i]);
  return draw;
}

}  // namespace

RobustFriction fit_friction(const std::vector<FrictionPoint>& points, const FrictionForm& form) {
  check(points, form);
  const Coefficients plain = plain_law(points, form);
  const FormCurve plain_curve(form, plain);
  double squares = 0;
  for (const FrictionPoint& point : points) squares += std::pow(residual(point, plain_curve), 2);

  double low = least_scatter_squared, high = std::max(2 * low, 4 * squares);
  Coefficients law = law_with_scatter(points, form, plain, low);
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
  const FormCurve curve(form, law);
  double sum = 0, outliers = 0;
  for (const FrictionPoint& point : points) {
    const CurvePoint at = curve.at(point.I);
    const double off = point.mu - at.value;
    sum += off * off;
    if (std::abs(off) > huber * std::sqrt(variance(point, at.slope, s2))) ++outliers;
  }
  fit.rms_misfit = std::sqrt(sum / static_cast<double>(points.size()));
  fit.outlier_share = outliers / static_cast<double>(points.size());
  return fit;
}

std::vector<Coefficients> bootstrapped(const std::vector<std::vector<FrictionPoint>>& runs,
                                       const FrictionForm& form, int replicates, std::uint64_t seed,
                                       const std::function<void()>& before_each) {
  std::vector<FrictionPoint> all;
  for (const auto& run : runs) all.insert(all.end(), run.begin(), run.end());
  const RobustFriction fit = fit_friction(all, form);
  const double s2 = std::max(least_scatter_squared, fit.intrinsic_scatter * fit.intrinsic_scatter);
  const auto count = std::ranges::count_if(runs, [](const Points& run) { return !run.empty(); });
  const double widening =
      small_sample_factor(all.size(), static_cast<std::size_t>(count), static_cast<int>(form.size()));
  const FormCurve curve(form, fit.law);
  // In the misfit where all runs are short: coefficients that trade against each other do not scale.
  const bool all_short = std::ranges::all_of(runs, is_short);
  const double of_misfit = all_short ? widening : 1, of_law = all_short ? 1 : widening;

  std::mt19937_64 random(seed);
  std::vector<Coefficients> laws;
  for (int replicate = 0; replicate < replicates; ++replicate) {
    if (before_each) before_each();
    std::vector<FrictionPoint> points;
    for (const auto& run : runs) {
      const Points draw = redrawn(run, curve, of_misfit, random);
      points.insert(points.end(), draw.begin(), draw.end());
    }
    Coefficients law = law_with_scatter(points, form, fit.law, s2);
    for (std::size_t j = 0; j < law.size(); ++j)
      law[j] = std::max(least_coefficient(form, j), fit.law[j] + of_law * (law[j] - fit.law[j]));
    laws.push_back(std::move(law));
  }
  return laws;
}

BandOfDraws::BandOfDraws(const FrictionForm& form, const std::vector<Coefficients>& laws) {
  for (const Coefficients& law : laws) curves_.emplace_back(form, law);
}

FrictionBand range_of(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  const auto quantile = [&](double of) {
    const double place = of * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, values.size() - 1);
    return values[below] + (place - static_cast<double>(below)) * (values[above] - values[below]);
  };
  return {quantile(0.5 * (1 - share)), quantile(0.5 * (1 + share))};
}

FrictionBand BandOfDraws::at(double I, double share) const {
  std::vector<double> values;
  for (const FormCurve& curve : curves_) values.push_back(curve.at(I).value);
  return range_of(std::move(values), share);
}

double BandOfDraws::half_width_at(double I) const {
  const FrictionBand band = at(I);
  return (band.high - band.low) / 2;
}

}  // namespace drumlin::coupling
