#include "coupling/calibration/memory_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "coupling/core/basics/no_value.hpp"
#include "coupling/core/law/memory_law.hpp"
#include "coupling/core/statistics/quantiles.hpp"
#include "coupling/core/statistics/resampling.hpp"
#include "coupling/core/statistics/samples.hpp"

namespace drumlin::coupling {
namespace {

constexpr double soft = 0.05;  // of s/p, beyond which a misfit counts less than its square
constexpr double degrees = 180 / std::numbers::pi;

using Vector3 = Eigen::Vector3d;  // ln c, m, chi
using Matrix3 = Eigen::Matrix3d;

Vector3 vector_of(const AxisMemory& law) { return {std::log(law.c), law.m, law.chi}; }

AxisMemory law_at(const Vector3& x, AxisMemory law) {
  law.c = std::exp(std::clamp(x(0), std::log(0.3), std::log(100.0)));
  law.m = std::clamp(x(1), 0.0, 2.0);
  law.chi = x(2);
  return law;
}

Deviator misfit(const PathsOfRun& run, std::size_t i, const AxisMemory& law) {
  return run.paths[i].stress - run.amounts[i] * carried_axes(run.paths[i], law);
}

double bounded_square(double distance) {
  const double x = distance / soft;
  return 2 * soft * soft * (std::sqrt(1 + x * x) - 1);
}

/// Sums over the paths of one sector: normal equations and cost at a law.
struct SectorSums {
  Matrix3 matrix = Matrix3::Zero();
  Vector3 right = Vector3::Zero();
  double cost = 0, squares = 0;
  std::size_t paths = 0;

  SectorSums& operator+=(const SectorSums& other) {
    matrix += other.matrix;
    right += other.right;
    cost += other.cost;
    squares += other.squares;
    paths += other.paths;
    return *this;
  }
};
using Sectors = std::map<long, SectorSums>;

Sectors sums_at(std::span<const PathsOfRun> runs, const Vector3& x, const AxisMemory& held,
                const std::array<bool, 3>& free, bool with_slopes) {
  constexpr double difference = 1e-4;
  Sectors sectors;
  const AxisMemory law = law_at(x, held);
  for (const PathsOfRun& run : runs)
    for (std::size_t i = 0; i < run.paths.size(); ++i) {
      SectorSums& sums = sectors[sector_of(run.paths[i])];
      const Deviator r = misfit(run, i, law);
      const double weight = 1 / std::sqrt(1 + std::norm(r) / (soft * soft));
      sums.cost += bounded_square(std::abs(r));
      sums.squares += std::norm(r);
      ++sums.paths;
      if (!with_slopes) continue;
      std::array<Deviator, 3> slope{};
      for (int j = 0; j < 3; ++j) {
        if (!free[static_cast<std::size_t>(j)]) continue;
        Vector3 aside = x;
        aside(j) += difference;
        slope[static_cast<std::size_t>(j)] = (r - misfit(run, i, law_at(aside, held))) / difference;
      }
      for (int j = 0; j < 3; ++j) {
        const Deviator a = slope[static_cast<std::size_t>(j)];
        sums.right(j) += weight * (std::conj(a) * r).real();
        for (int k = 0; k < 3; ++k)
          sums.matrix(j, k) += weight * (std::conj(a) * slope[static_cast<std::size_t>(k)]).real();
      }
    }
  return sectors;
}

SectorSums total_of(const Sectors& sectors) {
  SectorSums total;
  for (const auto& sector : sectors) total += sector.second;
  return total;
}

/// Step of Gauss and Newton; zero of what is held.
Vector3 step_of(const SectorSums& sums, const std::array<bool, 3>& free) {
  Matrix3 matrix = sums.matrix;
  Vector3 right = sums.right;
  for (int j = 0; j < 3; ++j) {
    if (free[static_cast<std::size_t>(j)]) {
      matrix(j, j) *= 1 + 1e-9;
      continue;
    }
    matrix.row(j).setZero();
    matrix.col(j).setZero();
    matrix(j, j) = 1;
    right(j) = 0;
  }
  return matrix.colPivHouseholderQr().solve(right);
}

/// The minimum and whether it was found.
struct Minimum {
  Vector3 x;
  bool found = false;
};

Minimum minimum_of(std::span<const PathsOfRun> runs, const AxisMemory& start,
                   const std::array<bool, 3>& free) {
  Minimum at{vector_of(start)};
  for (int round = 0; round < 60 && !at.found; ++round) {
    const SectorSums here = total_of(sums_at(runs, at.x, start, free, true));
    const Vector3 whole = step_of(here, free);
    if (!whole.allFinite()) return at;
    double share = 1;
    for (; share > 1e-3; share /= 2)
      if (total_of(sums_at(runs, at.x + share * whole, start, free, false)).cost <= here.cost) break;
    at.found = (share * whole).cwiseAbs().maxCoeff() < 1e-4 || share <= 1e-3;
    if (share > 1e-3) at.x = vector_of(law_at(at.x + share * whole, start));
  }
  return at;
}

/// Coefficients as they are reported, of a vector: c itself.
std::array<double, 3> reported(const Vector3& x) { return {std::exp(x(0)), x(1), x(2)}; }

/// Leaves out one sector each: by one step from the minimum.
void add_sector_intervals(const Sectors& sectors, const Vector3& x, MemoryFit& fit) {
  const SectorSums total = total_of(sectors);
  std::array<std::vector<double>, 3> without;
  for (const auto& sector : sectors) {
    SectorSums rest;
    for (const auto& other : sectors)
      if (other.first != sector.first) rest += other.second;
    const auto values = reported(x + step_of(rest, fit.free));
    for (std::size_t j = 0; j < 3; ++j) without[j].push_back(values[j]);
    fit.cost_without.push_back((total.cost - sector.second.cost) /
                               static_cast<double>(total.paths - sector.second.paths));
  }
  if (sectors.size() < 3) return;
  const double factor = statistics::student_quantile_99(static_cast<int>(sectors.size()) - 1);
  const auto deviation = [&](std::size_t j, std::size_t s) {
    return without[j][s] - statistics::mean(without[j]);
  };
  std::size_t pair = 0;
  for (std::size_t j = 0; j < 3; ++j) {
    if (fit.free[j]) fit.ci99_sectors[j] = factor * std::sqrt(statistics::jackknife_variance(without[j]));
    for (std::size_t k = j + 1; k < 3; ++k, ++pair) {
      double both = 0, first = 0, second = 0;
      for (std::size_t s = 0; s < sectors.size(); ++s) {
        both += deviation(j, s) * deviation(k, s);
        first += deviation(j, s) * deviation(j, s);
        second += deviation(k, s) * deviation(k, s);
      }
      if (fit.free[j] && fit.free[k]) fit.correlation[pair] = both / std::sqrt(first * second);
    }
  }
}

/// What the material commits to memory on a step.
Deviator committed(const PathStep& step, const AxisMemory& law) {
  return step.axis * std::polar(1.0, lead_angle(law, step.ln_I));
}

/// A after a step.
Deviator renewed(Deviator A, const PathStep& step, const AxisMemory& law) {
  const double gain = 2 * law.c * step.strain;
  const Deviator rate(gain, 2 * step.turn), left = std::exp(-rate);
  return left * A +
         (std::abs(rate) > 1e-12 ? gain / rate * (1.0 - left) : Deviator(gain)) * committed(step, law);
}

/// Angle in degrees by which the axes of a are turned from those of b.
double angle_deg(Deviator a, Deviator b) { return std::arg(a * std::conj(b)) * degrees / 2; }

}  // namespace

double lead_angle(const AxisMemory& law, double ln_I) {
  return memory_turn(law.chi, law.c, law.I_low, law.I_high, ln_I);
}

long sector_of(const StressPath& path) { return std::lround(path.depth_angle * degrees / sector_deg); }

Deviator carried_memory(const StressPath& path, const AxisMemory& law) {
  Deviator A = committed(path.steps.front(), law);
  for (const PathStep& step : path.steps) A = renewed(A, step, law);
  return A;
}

Deviator carried_axes(const StressPath& path, const AxisMemory& law) {
  Deviator A = committed(path.steps.front(), law);
  double rho = std::abs(path.steps.front().axis + law.m * A);
  for (const PathStep& step : path.steps) {
    A = renewed(A, step, law);
    if (!law.c_rho) continue;
    const double kept = std::exp(-2 * *law.c_rho * step.strain);
    rho = kept * rho + (1 - kept) * std::abs(step.axis + law.m * A);
  }
  const Deviator sum = path.axis + law.m * A;
  if (!law.c_rho) rho = std::abs(sum);
  return sum / std::max(rho, 1e-3);
}

PathsOfRun paths_of_run(std::string name, std::vector<StressPath> paths, const FormCurve& amount) {
  PathsOfRun run{std::move(name), std::move(paths), {}};
  for (const StressPath& path : run.paths) run.amounts.push_back(amount.at(std::exp(path.ln_I)).value);
  return run;
}

MemoryFit fit_memory(std::span<const PathsOfRun> runs, const AxisMemory& start,
                     const std::array<bool, 3>& free) {
  MemoryFit fit;
  fit.free = free;
  fit.ci99_sectors.fill(no_value);
  fit.ci99_runs.fill(no_value);
  fit.correlation.fill(no_value);
  const Minimum at = minimum_of(runs, start, free);
  fit.law = law_at(at.x, start);
  fit.converged = at.found;
  const Sectors sectors = sums_at(runs, at.x, start, free, true);
  const SectorSums total = total_of(sectors);
  const auto count = static_cast<double>(total.paths);
  fit.paths = total.paths;
  fit.rms = std::sqrt(total.squares / count);
  fit.cost = total.cost / count;
  add_sector_intervals(sectors, at.x, fit);
  return fit;
}

void add_run_intervals(std::span<const PathsOfRun> runs, MemoryFit& fit) {
  if (runs.size() < 2) return;
  std::array<std::vector<double>, 3> alone;
  for (const PathsOfRun& run : runs) {
    if (run.paths.empty()) return;
    const Minimum at = minimum_of({&run, 1}, fit.law, fit.free);
    if (!at.found) return;
    for (std::size_t j = 0; j < 3; ++j) alone[j].push_back(reported(at.x)[j]);
  }
  const double factor = statistics::student_quantile_99(static_cast<int>(runs.size()) - 1) /
                        std::sqrt(static_cast<double>(runs.size()));
  for (std::size_t j = 0; j < 3; ++j)
    if (fit.free[j]) fit.ci99_runs[j] = factor * std::sqrt(statistics::variance(alone[j]));
}

MemoryScore memory_score(const PathsOfRun& run, const AxisMemory& law) {
  MemoryScore score{run.name, {}, {}};
  const double bed_below = std::log(bed_I);
  for (auto [zone, in_bed] : {std::pair{&score.bed, true}, std::pair{&score.flow, false}}) {
    double squares = 0, angles = 0, coaxial_squares = 0, coaxial_angles = 0;
    for (std::size_t i = 0; i < run.paths.size(); ++i) {
      const StressPath& path = run.paths[i];
      if ((path.ln_I < bed_below) != in_bed) continue;
      ++zone->paths;
      squares += std::norm(misfit(run, i, law));
      angles += std::pow(angle_deg(path.stress, carried_axes(path, law)), 2);
      coaxial_squares += std::norm(path.stress - run.amounts[i] * path.axis);
      coaxial_angles += std::pow(angle_deg(path.stress, path.axis), 2);
    }
    if (zone->paths == 0) continue;
    const auto paths = static_cast<double>(zone->paths);
    const auto root = [paths](double sum) { return std::sqrt(sum / paths); };
    zone->rms = root(squares);
    zone->axes_deg = root(angles);
    zone->rms_without_memory = root(coaxial_squares);
    zone->axes_deg_without_memory = root(coaxial_angles);
  }
  return score;
}

std::vector<AxesOnArc> axes_on_arcs(std::span<const PathsOfRun> runs, const AxisMemory& law,
                                    double drum_radius) {
  constexpr double bin_deg = 5, half_width = 2;
  constexpr std::size_t least_paths = 3;
  const Deviator simple_shear(0, 1);
  std::vector<AxesOnArc> arcs;
  for (const double share : {0.87, 0.75, 0.63}) {
    const double middle = share * drum_radius;
    AxesOnArc arc{middle - half_width, middle + half_width, {}, {}, {}, {}, {}, {}};
    struct Sums {
      Deviator stress, law, rate;
      double amount = 0, law_amount = 0;
      std::size_t paths = 0;
    };
    std::map<long, Sums> bins;
    for (const PathsOfRun& run : runs)
      for (std::size_t i = 0; i < run.paths.size(); ++i) {
        const StressPath& path = run.paths[i];
        if (path.radius < arc.radius_from || path.radius > arc.radius_to) continue;
        Sums& sums = bins[std::lround(path.depth_angle * degrees / bin_deg)];
        const Deviator predicted = run.amounts[i] * carried_axes(path, law);
        sums.stress += path.stress;
        sums.law += predicted;
        sums.rate += path.axis;
        sums.amount += std::abs(path.stress);
        sums.law_amount += std::abs(predicted);
        ++sums.paths;
      }
    for (const auto& [bin, sums] : bins) {
      if (sums.paths < least_paths) continue;
      const auto count = static_cast<double>(sums.paths);
      arc.angle_deg.push_back(static_cast<double>(bin) * bin_deg);
      arc.stress_deg.push_back(angle_deg(sums.stress, simple_shear));
      arc.law_deg.push_back(angle_deg(sums.law, simple_shear));
      arc.rate_deg.push_back(angle_deg(sums.rate, simple_shear));
      arc.amount.push_back(sums.amount / count);
      arc.law_amount.push_back(sums.law_amount / count);
    }
    arcs.push_back(std::move(arc));
  }
  return arcs;
}

}  // namespace drumlin::coupling
