#include "coupling/calibration/amount_memory.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "coupling/calibration/bounded_least_squares.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/law/memory_law.hpp"
#include "coupling/core/statistics/quantiles.hpp"
#include "coupling/core/statistics/resampling.hpp"

namespace drumlin::coupling {
namespace {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

/// A mean of what a path passed through, the later the more: weight exp(-2 c strain).
double carried(const StressPath& path, const MemoryLaw& law, double c) {
  double value = remembered_ln_I(law, std::exp(path.steps.front().ln_I));
  for (const PathStep& step : path.steps) {
    const double kept = std::exp(-2 * c * step.strain);
    value = kept * value + (1 - kept) * remembered_ln_I(law, std::exp(step.ln_I));
  }
  return value;
}

/// The dilatancy felt at the end of a path over the swelling. What relaxes with c_psi to c_nu (ln I - L),
/// where L relaxes with c_nu to ln I, is the difference of two such means.
double felt_dilatancy(const StressPath& path, const MemoryLaw& law, double c_nu, double c_psi) {
  return c_nu * c_psi / (c_psi - c_nu) * (carried(path, law, c_psi) - carried(path, law, c_nu));
}

/// The same of the dilatancy that the path passed through itself.
double seen_dilatancy(const StressPath& path, double c_psi) {
  constexpr double most = 0.5;  // where the material hardly shears its dilatancy is noise
  double Q = 0;
  for (const PathStep& step : path.steps) {
    const double kept = std::exp(-2 * c_psi * step.strain);
    Q = kept * Q + (1 - kept) * std::clamp(step.dilatancy, -most, most);
  }
  return Q;
}

double lag_of(const StressPath& path, const MemoryLaw& law) {
  const AxisMemory axes{law.c, law.m, law.chi_deg * (std::numbers::pi / 180), {}, law.I_low, law.I_high};
  return axes_lag(law, 1, path.axis, carried_memory(path, axes), std::exp(path.ln_I));
}

/// Normal equations of the paths of one sector of the drum. Unknowns: those of a table, then three more.
struct Sums {
  Matrix matrix;
  Vector right;
  double squares = 0;
  std::size_t paths = 0;

  void add(const Vector& row, double value) {
    if (paths == 0) {
      matrix = Matrix::Zero(row.size(), row.size());
      right = Vector::Zero(row.size());
    }
    matrix.noalias() += row * row.transpose();
    right += row * value;
    squares += value * value;
    ++paths;
  }
  Sums& operator+=(const Sums& other) {
    if (paths == 0) return *this = other;
    matrix += other.matrix;
    right += other.right;
    squares += other.squares;
    paths += other.paths;
    return *this;
  }
  Sums without(const Sums& other) const {
    return {matrix - other.matrix, right - other.right, squares - other.squares, paths - other.paths};
  }
  /// None below its least value; what no path tells of is that, or 0 where it has none.
  Vector solution(const std::vector<double>& least) const {
    NormalEquations equations(least.size());
    Eigen::Map<Matrix> padded(equations.matrix.data(), matrix.rows(), matrix.cols());
    padded = matrix;
    padded.diagonal().array() += 1e-12 * matrix.diagonal().maxCoeff();
    Eigen::Map<Vector>(equations.right.data(), right.size()) = right;
    const std::vector<double> found = bounded_minimum(equations, least);
    return Eigen::Map<const Vector>(found.data(), right.size());
  }
  /// All but a creep that no path has.
  bool is_determined() const {
    const Eigen::Index without_creep = matrix.diagonal().tail<1>()[0] > 0 ? 0 : 1;
    return Eigen::CompleteOrthogonalDecomposition<Matrix>(matrix).rank() == matrix.rows() - without_creep;
  }
  double rms(const Vector& x) const {
    return std::sqrt(std::max(0.0, squares - 2 * x.dot(right) + x.dot(matrix * x)) /
                     static_cast<double>(paths));
  }
};

/// A table straight in ln I, whose unknowns are its first value and its growth from knot to knot, and room
/// for three numbers more.
Vector growth_weights(const std::vector<double>& knots, double ln_I) {
  const auto count = static_cast<Eigen::Index>(knots.size());
  Vector row = Vector::Zero(count + 3);
  row[0] = 1;
  for (Eigen::Index j = 1; j < count; ++j) {
    const double from = std::log(knots[static_cast<std::size_t>(j) - 1]),
                 to = std::log(knots[static_cast<std::size_t>(j)]);
    row[j] = std::clamp((ln_I - from) / (to - from), 0.0, 1.0);
  }
  return row;
}

/// Knots of mu(I) beside a creep: the first, which says from where on I is remembered, those above the I that
/// the paths have where creep begins, in the mean of its logarithm, and in the flow octaves down from their
/// largest I: there mu grows faster and faster with ln I.
std::vector<double> knots_beside(std::span<const PathsOfRun> runs, std::vector<double> knots, double ratio) {
  constexpr double flow_I = 1e-2;
  double sum = 0, count = 0, largest = std::log(knots.front());
  for (const PathsOfRun& run : runs)
    for (const StressPath& path : run.paths) {
      largest = std::max(largest, path.ln_I);
      if (!(path.spin_share > 0)) continue;
      sum += path.ln_I + std::log(path.spin_share);
      ++count;
    }
  const double begins = count > 0 ? ratio * std::exp(sum / count) : 0;
  const double first = knots.front(), last = std::exp(largest);
  std::erase_if(knots,
                [&](double I) { return I > first && (I < begins || I > flow_I / 1.5 || I > last / 1.5); });
  const auto octaves = static_cast<int>(std::max(0.0, std::floor(std::log2(last / flow_I))));
  for (int octave = -octaves; octave <= 0; ++octave)
    if (std::ldexp(last, octave) > knots.back()) knots.push_back(std::ldexp(last, octave));
  return knots;
}

/// A path, and of its row in the normal equations what no trial of the rates changes: all but the dilatancy.
struct Sample {
  const StressPath* path;
  Vector row;
};

/// What all trials with one ratio of creep share.
struct Samples {
  double creep_ratio = 0;
  FrictionForm table;
  std::vector<double> least;  // of the unknowns
  std::vector<Sample> paths;
};

Samples samples_of(std::span<const PathsOfRun> runs, const MemoryLaw& axes, const FrictionForm& alone,
                   double creep_ratio) {
  Samples samples{creep_ratio, {FormKind::table, knots_beside(runs, alone.knots, creep_ratio)}, {}, {}};
  for (std::size_t j = 0; j < samples.table.size(); ++j)
    samples.least.push_back(least_coefficient(samples.table, j));
  const double any = -std::numeric_limits<double>::infinity();
  samples.least.insert(samples.least.end(), {any, any, 0});
  for (const PathsOfRun& run : runs)
    for (const StressPath& path : run.paths) {
      Vector row = growth_weights(samples.table.knots, path.ln_I);
      row.tail<3>()[amount_lag] = -lag_of(path, axes);
      row.tail<3>()[amount_creep] = creep_friction({1, creep_ratio}, 1, path.spin_share);
      samples.paths.push_back({&path, std::move(row)});
    }
  return samples;
}

struct Trial {
  AmountTrial trial;
  Vector x;
  std::map<long, Sums> sectors;
  Sums total;
};

/// `dilatancy` of a path: what its first coefficient beside the table belongs to.
template <class Dilatancy>
Trial tried(const Samples& samples, double c_nu, double c_psi, Dilatancy dilatancy) {
  Trial found{{c_nu, c_psi, samples.creep_ratio}, {}, {}, {}};
  for (const Sample& sample : samples.paths) {
    Vector row = sample.row;
    row.tail<3>()[amount_swelling] = dilatancy(*sample.path);
    found.sectors[sector_of(*sample.path)].add(row, std::abs(sample.path->stress));
  }
  for (const auto& [number, sums] : found.sectors) found.total += sums;
  found.x = found.total.solution(samples.least);
  found.trial.rms = found.total.rms(found.x);
  return found;
}

std::array<double, 3> sector_intervals(const Trial& best, const std::vector<double>& least) {
  std::array<std::vector<double>, 3> without;
  for (const auto& [number, sums] : best.sectors) {
    const Vector x = best.total.without(sums).solution(least);
    for (std::size_t j = 0; j < 3; ++j) without[j].push_back(x.tail<3>()[static_cast<Eigen::Index>(j)]);
  }
  const double factor = statistics::student_quantile_99(static_cast<int>(best.sectors.size()) - 1);
  std::array<double, 3> intervals;
  for (std::size_t j = 0; j < 3; ++j)
    intervals[j] = factor * std::sqrt(statistics::jackknife_variance(without[j]));
  return intervals;
}

/// Nothing where the motion has no dilatation.
std::optional<StressDilatancy> stress_dilatancy(const Samples& samples) {
  std::optional<StressDilatancy> found;
  for (const double c_psi : {2.0, 4.0, 6.0, 8.0, 12.0, 16.0, 24.0, 32.0}) {
    const Trial now =
        tried(samples, 0, c_psi, [&](const StressPath& path) { return seen_dilatancy(path, c_psi); });
    if (!now.total.is_determined()) return {};
    if (found && !(now.trial.rms < found->rms)) continue;
    const auto more = now.x.tail<3>();
    found = {c_psi, more[amount_swelling], sector_intervals(now, samples.least)[amount_swelling],
             more[amount_lag], now.trial.rms};
  }
  return found;
}

std::vector<AmountScore> scores_of(std::span<const PathsOfRun> runs, const MemoryLaw& law,
                                   const FormCurve& alone) {
  const TabulatedLaw table = memory_friction(law);
  std::vector<AmountScore> scores;
  for (const PathsOfRun& run : runs) {
    double squares[2][2] = {};
    std::size_t paths[2] = {};
    for (const StressPath& path : run.paths) {
      const std::size_t zone = path.ln_I < std::log(bed_I) ? 0 : 1;
      const double I = std::exp(path.ln_I), amount = std::abs(path.stress);
      const double own_I = I * std::sqrt(1 + law.amount->own_weight / path.p);
      ++paths[zone];
      squares[zone][0] += std::pow(amount - table.friction(I).mu - added_amount(path, law), 2);
      squares[zone][1] += std::pow(amount - alone.at(own_I).value, 2);
    }
    const auto rms = [&](std::size_t zone, std::size_t which) {
      return std::sqrt(squares[zone][which] / static_cast<double>(paths[zone]));
    };
    scores.push_back({run.name, rms(0, 0), rms(1, 0), rms(0, 1), rms(1, 1)});
  }
  return scores;
}

}  // namespace

double added_amount(const StressPath& path, const MemoryLaw& law) {
  const AmountMemory& amount = law.amount.value();
  return amount.swelling * felt_dilatancy(path, law, amount.c_nu, amount.c_psi) -
         amount.lag * lag_of(path, law) +
         (amount.creep ? creep_friction(*amount.creep, 1, path.spin_share) : 0);
}

AmountFit fit_amount(std::span<const PathsOfRun> runs, std::span<const PathsOfRun> held_out, MemoryLaw axes,
                     const CalibratedLaw& alone, double own_weight) {
  AmountFit found;
  axes.mu.I = knots_beside(runs, alone.form.knots, 0);  // ends of what is remembered
  Trial best;
  for (const double creep_ratio : {0.02, 0.035, 0.05, 0.07, 0.1}) {
    const Samples samples = samples_of(runs, axes, alone.form, creep_ratio);
    for (const double c_nu : {2.0, 3.0, 4.0, 6.0, 8.0})
      for (const double c_psi : {8.0, 12.0, 16.0, 24.0, 32.0}) {
        if (!(c_nu < c_psi)) continue;
        Trial now = tried(samples, c_nu, c_psi,
                          [&](const StressPath& path) { return felt_dilatancy(path, axes, c_nu, c_psi); });
        if (!now.total.is_determined())
          throw InputError(
              "--amount: the paths do not determine what the past adds to the amount of the stress");
        found.trials.push_back(now.trial);
        if (best.sectors.empty() || now.trial.rms < best.trial.rms) best = std::move(now);
      }
  }
  Samples of_best = samples_of(runs, axes, alone.form, best.trial.creep_ratio);
  const auto more = best.x.tail<3>();
  found.law = {more[amount_swelling], best.trial.c_nu, best.trial.c_psi, more[amount_lag]};
  found.law.own_weight = own_weight;
  if (more[amount_creep] > 0) found.law.creep = {more[amount_creep], best.trial.creep_ratio};
  found.ci99_sectors = sector_intervals(best, of_best.least);
  found.measured = stress_dilatancy(of_best);
  MemoryLaw law = axes;
  law.amount = found.law;
  std::vector<std::vector<FrictionPoint>> left;
  for (const PathsOfRun& run : runs) {
    left.emplace_back();
    for (const StressPath& path : run.paths)
      left.back().push_back(
          {.I = std::exp(path.ln_I), .mu = std::abs(path.stress) - added_amount(path, law)});
  }
  of_best.table.slope_besides = followed_slope(found.law);
  found.table = calibrated(left, of_best.table, 0);
  law.mu =
      std::get<TabulatedLaw>(measured_friction(found.table.form, found.table.fit.law, {}, 0, 0)).points();
  const FormCurve without = alone.curve();
  found.scores = scores_of(runs, law, without);
  found.predictions = scores_of(held_out, law, without);
  return found;
}

}  // namespace drumlin::coupling
