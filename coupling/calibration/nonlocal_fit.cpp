#include "coupling/calibration/nonlocal_fit.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>

#include "coupling/calibration/memory_fit.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/statistics/quantiles.hpp"
#include "coupling/core/statistics/resampling.hpp"

namespace drumlin::coupling {
namespace {

constexpr std::size_t least_bed_points = 50;
constexpr double threshold_step = 0.002;   // of the mu_s that are tried
constexpr double friction_bin = 0.02;      // of the table of lengths
constexpr double told_apart_share = 0.05;  // of a root mean square: less is no difference

/// ln g at a node; NaN where nothing is known or nothing shears.
double ln_fluidity(const PathPoint& at) {
  const double rate = std::abs(at.rate), mu = std::abs(at.stress) / at.p;
  return rate > 0 && mu > 0 && at.p > 0 ? std::log(2 * rate / mu) : std::numeric_limits<double>::quiet_NaN();
}

/// lap g/g = lap ln g + |grad ln g|^2 at (x, z) from a quadratic through the nodes around it.
std::optional<double> curvature_at(const PathFields& fields, const std::vector<double>& ln_g, double x,
                                   double z, const FluidityOptions& options) {
  const MapGrid& grid = fields.grid();
  std::vector<std::array<double, 3>> near;  // dx, dz, ln g
  for (std::size_t row = 0; row < grid.rows; ++row) {
    const double dz = grid.z_of(row) - z;
    if (std::abs(dz) >= options.reach) continue;
    for (std::size_t column = 0; column < grid.columns; ++column) {
      const double dx = grid.x_of(column) - x, y = ln_g[row * grid.columns + column];
      if (std::hypot(dx, dz) < options.reach && std::isfinite(y)) near.push_back({dx, dz, y});
    }
  }
  if (near.size() < options.least_nodes) return std::nullopt;
  Eigen::MatrixXd terms(near.size(), 6);
  Eigen::VectorXd values(near.size());
  for (std::size_t i = 0; i < near.size(); ++i) {
    const auto [dx, dz, y] = near[i];
    const auto row = static_cast<Eigen::Index>(i);
    terms.row(row) << 1, dx, dz, dx * dx, dx * dz, dz * dz;
    values[row] = y;
  }
  const Eigen::VectorXd fit = terms.colPivHouseholderQr().solve(values);
  return 2 * (fit[3] + fit[5]) + fit[1] * fit[1] + fit[2] * fit[2];
}

using FluidityPoints = std::vector<const FluidityPoint*>;

double local_friction(const FormCurve& amount, const FluidityPoint& at) { return amount.at(at.I).value; }

/// Amplitude at a given threshold, and the sum of squares that is left.
std::pair<double, double> amplitude_at(const FluidityPoints& points, const std::vector<double>& local,
                                       double mu_s) {
  double product = 0, square = 0, sum = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double missing = std::max(local[i], mu_s) - points[i]->mu, q = points[i]->curvature;
    product += missing * q;
    square += q * q;
    sum += missing * missing;
  }
  const double A2 = square > 0 ? std::max(0.0, product / square) : 0;
  return {std::sqrt(A2), sum - 2 * A2 * product + A2 * A2 * square};
}

std::vector<double> locals(const FluidityPoints& points, const FormCurve& amount) {
  std::vector<double> local;
  for (const FluidityPoint* point : points) local.push_back(local_friction(amount, *point));
  return local;
}

NonlocalLength best_threshold(const FluidityPoints& points, const FormCurve& amount) {
  const std::vector<double> local = locals(points, amount);
  const auto [low, high] = std::minmax_element(local.begin(), local.end());
  NonlocalLength best;
  double least = std::numeric_limits<double>::infinity();
  for (double mu_s = *low; mu_s <= *high; mu_s += threshold_step) {
    const auto [A, sum] = amplitude_at(points, local, mu_s);
    if (sum < least) least = sum, best.amplitude = A, best.mu_s = mu_s;
  }
  return best;
}

/// Of mu_loc(I) without a threshold where `law` is null.
double rms_of(const FluidityPoints& points, const FormCurve& amount, const NonlocalLength* law,
              double I_below) {
  double sum = 0, count = 0;
  for (const FluidityPoint* point : points) {
    if (point->I >= I_below) continue;
    double mu = local_friction(amount, *point);
    if (law != nullptr) mu = std::max(mu, law->mu_s) - law->amplitude * law->amplitude * point->curvature;
    sum += (mu - point->mu) * (mu - point->mu);
    count += 1;
  }
  return std::sqrt(sum / count);
}

void add_intervals(const FluidityPoints& points, const FormCurve& amount, NonlocalLength& law) {
  std::set<long> sectors;
  for (const FluidityPoint* point : points) sectors.insert(point->sector);
  if (sectors.size() < 3) return;
  std::vector<double> amplitudes, thresholds;
  for (const long left_out : sectors) {
    FluidityPoints others;
    for (const FluidityPoint* point : points)
      if (point->sector != left_out) others.push_back(point);
    const NonlocalLength without = best_threshold(others, amount);
    amplitudes.push_back(without.amplitude);
    thresholds.push_back(without.mu_s);
  }
  const double t = statistics::student_quantile_99(static_cast<int>(sectors.size()) - 1);
  law.amplitude_ci99 = t * std::sqrt(statistics::jackknife_variance(amplitudes));
  law.mu_s_ci99 = t * std::sqrt(statistics::jackknife_variance(thresholds));
}

std::vector<LengthOverFriction> lengths_of(const FluidityPoints& points) {
  std::vector<LengthOverFriction> all;
  for (int bin = 0; bin < static_cast<int>(std::lround(1 / friction_bin)); ++bin) {
    LengthOverFriction length{bin * friction_bin, (bin + 1) * friction_bin, 0, 0, 0};
    double ln_I = 0;
    for (const FluidityPoint* point : points) {
      if (point->mu < length.mu_from || point->mu >= length.mu_to) continue;
      ++length.points;
      ln_I += std::log(point->I);
      length.curvature += point->curvature;
    }
    if (length.points < 5) continue;
    const auto count = static_cast<double>(length.points);
    length.I = std::exp(ln_I / count);
    length.curvature /= count;
    all.push_back(length);
  }
  return all;
}

/// Of mu and lap g/g where I < bed_I.
double correlation_in_bed(const FluidityPoints& points) {
  double n = 0, mu = 0, q = 0, mu2 = 0, q2 = 0, both = 0;
  for (const FluidityPoint* point : points) {
    if (point->I >= bed_I) continue;
    n += 1, mu += point->mu, q += point->curvature;
    mu2 += point->mu * point->mu, q2 += point->curvature * point->curvature;
    both += point->mu * point->curvature;
  }
  return (n * both - mu * q) / std::sqrt((n * mu2 - mu * mu) * (n * q2 - q * q));
}

std::vector<std::string> what_is_untold(const NonlocalFit& fit) {
  std::vector<std::string> untold;
  const NonlocalLength& law = fit.law;
  if (fit.rms_bed > (1 - told_apart_share) * fit.local_rms_bed)
    untold.push_back(
        fmt::format("a threshold: |s|/p that follows I in the bed leaves {:.4f} (rms), the best threshold "
                    "{:.4f}: the runs do not require one",
                    fit.local_rms_bed, fit.rms_bed));
  if (!fit.is_told())
    untold.push_back(fmt::format(
        "a length: A = {:.2f} is not distinguished from 0, and the law is left without one", law.amplitude));
  untold.push_back(
      fmt::format("what stops flow: a threshold asks lap g/g to fall in a line as |s|/p rises to mu_s; their "
                  "correlation in the bed is {:+.2f}",
                  fit.correlation_bed));
  return untold;
}

}  // namespace

bool NonlocalFit::is_told() const { return law.amplitude_ci99 && law.amplitude > *law.amplitude_ci99; }

double LengthOverFriction::xi() const { return 1 / std::sqrt(curvature); }

std::vector<FluidityPoint> fluidity_points(const PathFields& fields, const FluidityOptions& options) {
  const MapGrid& grid = fields.grid();
  std::vector<double> ln_g(grid.nodes(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t node = 0; node < grid.nodes(); ++node)
    if (fields.speaks(node))
      ln_g[node] = ln_fluidity(fields.at(grid.x_of(node % grid.columns), grid.z_of(node / grid.columns)));
  const auto every = [&](double spacing) {
    return std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(options.spacing / spacing)));
  };
  std::vector<FluidityPoint> points;
  for (std::size_t column = 0; column < grid.columns; column += every(grid.spacing_x))
    for (std::size_t row = 0; row < grid.rows; row += every(grid.spacing_z)) {
      const double x = grid.x_of(column), z = grid.z_of(row), depth = fields.axis() - z;
      if (!std::isfinite(ln_g[row * grid.columns + column])) continue;
      if (z > -options.surface_margin || z > fields.surface(x) - options.surface_margin) continue;
      if (std::hypot(x, depth) > fields.radius() - options.wall_margin) continue;
      const auto curvature = curvature_at(fields, ln_g, x, z, options);
      if (!curvature) continue;
      const PathPoint at = fields.at(x, z);
      const double angle_deg = std::atan2(x, depth) * 180 / std::numbers::pi;
      points.push_back({x, z, std::lround(std::floor(angle_deg / sector_deg)),
                        2 * std::abs(at.rate) / std::sqrt(at.p), std::abs(at.stress) / at.p, *curvature});
    }
  return points;
}

NonlocalFit fit_nonlocal(std::span<const FluidityOfRun> runs, const FormCurve& amount) {
  FluidityPoints points;
  std::size_t bed = 0;
  for (const FluidityOfRun& run : runs)
    for (const FluidityPoint& point : run.points) {
      points.push_back(&point);
      if (point.I < bed_I) ++bed;
    }
  if (bed < least_bed_points)
    throw InputError(fmt::format(
        "--nonlocal: {} points with I < {:g} (needed: {}): how flow decays shows in a bed; take runs of a "
        "larger drum",
        bed, bed_I, least_bed_points));
  constexpr double all = std::numeric_limits<double>::infinity();
  NonlocalFit fit;
  fit.points = points.size();
  fit.law = best_threshold(points, amount);
  add_intervals(points, amount, fit.law);
  fit.rms = rms_of(points, amount, &fit.law, all);
  fit.rms_bed = rms_of(points, amount, &fit.law, bed_I);
  fit.local_rms = rms_of(points, amount, nullptr, all);
  fit.local_rms_bed = rms_of(points, amount, nullptr, bed_I);
  const std::vector<double> local = locals(points, amount);
  for (int step = 9; step < 15; ++step) {
    NonlocalLength at{.amplitude = 0, .mu_s = step * friction_bin};
    at.amplitude = amplitude_at(points, local, at.mu_s).first;
    fit.given.emplace_back(rms_of(points, amount, &at, bed_I), at);
  }
  fit.correlation_bed = correlation_in_bed(points);
  fit.lengths = lengths_of(points);
  fit.untold = what_is_untold(fit);
  return fit;
}

}  // namespace drumlin::coupling
