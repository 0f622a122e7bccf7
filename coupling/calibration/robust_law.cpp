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

constexpr double huber = 1.5;      // Huber's k
constexpr double kept = 0.778474;  // mean of min(z^2, k^2) of a normal z
constexpr int block_length = 4;
// Points exactly on a law have no scatter, yet their weights must stay finite.
constexpr double least_scatter_squared = 1e-24;

double known(double error) { return std::isfinite(error) ? error : 0; }

double residual(const FrictionPoint& point, const FrictionForm& form, const Coefficients& law) {
  return point.mu - friction(form, law, point.I);
}

double variance(const FrictionPoint& point, const FrictionForm& form, const Coefficients& law,
                double scatter_squared) {
  const double slope = friction_slope(form, law, point.I);
  return std::pow(known(point.mu_error), 2) + std::pow(slope * known(point.I_error) / point.I, 2) +
         scatter_squared;
}

// Least squares in normal form, each coefficient at its least value or above.
class BoundedLeastSquares {
 public:
  BoundedLeastSquares(const std::vector<FrictionPoint>& points, const std::vector<double>& weight,
                      const FrictionForm& form)
      : form_(form), size_(static_cast<Eigen::Index>(form.size())) {
    matrix_ = Eigen::MatrixXd::Zero(size_, size_);
    right_ = Eigen::VectorXd::Zero(size_);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::vector<double> functions = functions_at(form, points[i].I);
      const Eigen::Map<const Eigen::VectorXd> f(functions.data(), size_);
      matrix_ += weight[i] * f * f.transpose();
      right_ += weight[i] * points[i].mu * f;
    }
    if (form.kind == FormKind::table) add_smoothness(weight);
    least_.resize(size_);
    for (Eigen::Index j = 0; j < size_; ++j) least_(j) = least_coefficient(form, static_cast<std::size_t>(j));
  }

  Coefficients solution() const {
    std::vector<bool> held(form_.size(), false);
    Eigen::VectorXd law = with(held);
    // Each change of the set lowers the misfit or mends a bound; the limit is for rounding that cycles.
    for (Eigen::Index round = 0; round < 4 * size_; ++round) {
      if (!changed(held, law)) break;
      law = with(held);
    }
    return {law.data(), law.data() + size_};
  }

 private:
  bool is_held(const std::vector<bool>& held, Eigen::Index j) const {
    return held[static_cast<std::size_t>(j)];
  }

  // A draw may leave an interval of the table without points. That neighbouring intervals are equally steep
  // then decides, with the weight of a hundredth of a point.
  void add_smoothness(const std::vector<double>& weight) {
    double mean = 0;
    for (const double w : weight) mean += w / static_cast<double>(weight.size());
    for (Eigen::Index j = 1; j + 1 < size_; ++j) {
      const auto width = [&](Eigen::Index k) {
        return std::log(form_.knots[static_cast<std::size_t>(k)] /
                        form_.knots[static_cast<std::size_t>(k - 1)]);
      };
      Eigen::VectorXd bend = Eigen::VectorXd::Zero(size_);
      bend(j) = 1 / width(j);
      bend(j + 1) = -1 / width(j + 1);
      const double span = 0.5 * (width(j) + width(j + 1));
      matrix_ += 0.01 * mean * span * span * bend * bend.transpose();
    }
  }

  Eigen::VectorXd with(const std::vector<bool>& held) const {
    Eigen::MatrixXd matrix = matrix_;
    Eigen::VectorXd right = right_;
    for (Eigen::Index j = 0; j < size_; ++j) {
      if (!is_held(held, j)) continue;
      right -= matrix.col(j) * least_(j);
      matrix.row(j).setZero();
      matrix.col(j).setZero();
      matrix(j, j) = 1;
      right(j) = least_(j);
    }
    const Eigen::VectorXd scale = matrix.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
    return scale.asDiagonal() *
           scaled.colPivHouseholderQr().solve((scale.asDiagonal() * right).eval()).eval();
  }

  // Holds what fell below; where nothing did, lets go of the one that wants to rise most.
  bool changed(std::vector<bool>& held, const Eigen::VectorXd& law) const {
    bool any = false;
    for (Eigen::Index j = 0; j < size_; ++j)
      if (!is_held(held, j) && law(j) < least_(j)) any = held[static_cast<std::size_t>(j)] = true;
    if (any) return true;
    const Eigen::VectorXd rise = right_ - matrix_ * law;
    Eigen::Index best = -1;
    double strongest = 0;
    for (Eigen::Index j = 0; j < size_; ++j) {
      const double wish = rise(j) / std::sqrt(matrix_(j, j));
      if (is_held(held, j) && wish > strongest + 1e-9 * right_.norm()) {
        strongest = wish;
        best = j;
      }
    }
    if (best < 0) return false;
    held[static_cast<std::size_t>(best)] = false;
    return true;
  }

  const FrictionForm& form_;
  Eigen::Index size_;
  Eigen::MatrixXd matrix_;
  Eigen::VectorXd right_;
  Eigen::VectorXd least_;
};

Coefficients growing_law(const std::vector<FrictionPoint>& points, const std::vector<double>& weight,
                         const FrictionForm& form) {
  return BoundedLeastSquares(points, weight, form).solution();
}

// Law for a given scatter; its weights depend on the law.
Coefficients law_with_scatter(const std::vector<FrictionPoint>& points, const FrictionForm& form,
                              Coefficients law, double scatter_squared) {
  std::vector<double> weight(points.size());
  for (int round = 0; round < 15; ++round) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double v = variance(points[i], form, law, scatter_squared);
      const double off = std::abs(residual(points[i], form, law)) / std::sqrt(v);
      weight[i] = std::min(1.0, huber / std::max(off, 1e-300)) / v;
    }
    law = growing_law(points, weight, form);
  }
  return law;
}

// Mean of the bounded squares over what it would be if the variances were right.
double excess(const std::vector<FrictionPoint>& points, const FrictionForm& form, const Coefficients& law,
              double scatter_squared) {
  double sum = 0;
  for (const FrictionPoint& point : points)
    sum += std::min(std::pow(residual(point, form, law), 2) / variance(point, form, law, scatter_squared),
                    huber * huber);
  const double freedom = static_cast<double>(points.size()) - static_cast<double>(form.size());
  return sum / (kept * freedom);
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

RobustFriction fit_friction(const std::vector<FrictionPoint>& points, const FrictionForm& form) {
  check(points, form);
  const Coefficients plain = growing_law(points, std::vector<double>(points.size(), 1.0), form);
  double squares = 0;
  for (const FrictionPoint& point : points) squares += std::pow(residual(point, form, plain), 2);

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
  double sum = 0, outliers = 0;
  for (const FrictionPoint& point : points) {
    const double off = residual(point, form, law);
    sum += off * off;
    if (std::abs(off) > huber * std::sqrt(variance(point, form, law, s2))) ++outliers;
  }
  fit.rms_misfit = std::sqrt(sum / static_cast<double>(points.size()));
  fit.outlier_share = outliers / static_cast<double>(points.size());
  return fit;
}

std::vector<Coefficients> bootstrapped(const std::vector<std::vector<FrictionPoint>>& runs,
                                       const FrictionForm& form, int replicates, std::uint64_t seed) {
  std::vector<FrictionPoint> all;
  for (const auto& run : runs) all.insert(all.end(), run.begin(), run.end());
  const RobustFriction fit = fit_friction(all, form);
  const double s2 = std::max(least_scatter_squared, fit.intrinsic_scatter * fit.intrinsic_scatter);
  const double widening = small_sample_factor(all.size(), static_cast<int>(form.size()));

  std::mt19937_64 random(seed);
  std::vector<Coefficients> laws;
  for (int replicate = 0; replicate < replicates; ++replicate) {
    std::vector<FrictionPoint> points;
    for (const auto& run : runs) {
      if (run.empty()) continue;
      const auto draw = redrawn(run, random);
      points.insert(points.end(), draw.begin(), draw.end());
    }
    Coefficients law = law_with_scatter(points, form, fit.law, s2);
    for (std::size_t j = 0; j < law.size(); ++j)
      law[j] = std::max(least_coefficient(form, j), fit.law[j] + widening * (law[j] - fit.law[j]));
    laws.push_back(std::move(law));
  }
  return laws;
}

FrictionBand band_at(const FrictionForm& form, const std::vector<Coefficients>& laws, double I,
                     double share) {
  std::vector<double> values;
  for (const Coefficients& law : laws) values.push_back(friction(form, law, I));
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
