#include "coupling/calibration/memory_calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <variant>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/statistics/quantiles.hpp"
#include "coupling/core/statistics/resampling.hpp"

namespace drumlin::coupling {
namespace {

constexpr std::size_t least_amounts = 24;  // fewer hold no knots of a table
constexpr std::size_t least_bed_paths = 100;
constexpr std::size_t least_bed_sectors = 5;
constexpr AxisMemory first_guess{.c = 6, .m = 1, .chi = 0.5};

using Runs = std::vector<PathsOfRun>;

std::optional<RobustFriction> fitted_bed_line(std::span<const RunEvidence> runs) {
  std::vector<FrictionPoint> bed;
  for (const RunEvidence& run : runs)
    for (const FrictionPoint& point : amounts(run.amount_blocks))
      if (point.I < bed_I) bed.push_back(point);
  if (bed.size() < 10) return std::nullopt;
  return fit_friction(bed, {.kind = FormKind::log});
}

Runs paths_of(std::span<const RunEvidence> runs, const FormCurve& amount, double own_weight,
              std::vector<double>* shares) {
  Runs all;
  for (const RunEvidence& run : runs) {
    const PathFields fields(*run.map);
    if (shares != nullptr) shares->push_back(fields.share_from_displacements());
    all.push_back(paths_of_run(run.name, stress_paths(fields), amount));
    add_own_weight(all.back().paths, own_weight);
  }
  return all;
}

void require_bed(const Runs& runs) {
  std::size_t paths = 0;
  std::set<long> sectors;
  for (const PathsOfRun& run : runs)
    for (const StressPath& path : run.paths) {
      if (path.ln_I >= std::log(bed_I)) continue;
      ++paths;
      sectors.insert(sector_of(path));
    }
  if (paths >= least_bed_paths && sectors.size() >= least_bed_sectors) return;
  throw InputError(fmt::format(
      "--memory: too little bed: {} paths end where I < {:g}, in {} sectors of {:g} deg (needed: {} "
      "in {}); the axes of the stress remember in the bed alone, so take runs of a larger drum",
      paths, bed_I, sectors.size(), sector_deg, least_bed_paths, least_bed_sectors));
}

/// Trials of the range over which chi falls: half decades.
std::vector<LeadTrial> lead_trials(const Runs& runs) {
  std::vector<LeadTrial> trials;
  AxisMemory start = first_guess;
  for (const double low : {1e-3, 3e-3, 1e-2, 3e-2})
    for (const double high : {1e-2, 3e-2, 1e-1}) {
      if (!(low < high)) continue;
      start.I_low = low;
      start.I_high = high;
      const MemoryFit fit = fit_memory(runs, start, {true, false, true});
      trials.push_back({low, high, fit.cost});
      start = fit.law;
    }
  return trials;
}

const LeadTrial& best_of(const std::vector<LeadTrial>& trials) {
  return *std::min_element(trials.begin(), trials.end(),
                           [](const auto& a, const auto& b) { return a.cost < b.cost; });
}

/// Over the paths that end in the bed, with a chi that does not fall.
MemoryFit bed_fit(const Runs& runs) {
  Runs bed;
  for (const PathsOfRun& run : runs) {
    bed.push_back({run.name, {}, {}});
    for (std::size_t i = 0; i < run.paths.size(); ++i) {
      if (run.paths[i].ln_I >= std::log(bed_I)) continue;
      bed.back().paths.push_back(run.paths[i]);
      bed.back().amounts.push_back(run.amounts[i]);
    }
  }
  AxisMemory start = first_guess;
  start.I_low = 1e6;  // beyond every I
  start.I_high = 1e7;
  MemoryFit fit = fit_memory(bed, start, {true, true, true});
  add_run_intervals(bed, fit);
  return fit;
}

MemoryFit bounded_fit(const Runs& runs, const MemoryFit& free) {
  if (free.law.m <= 1) return free;
  AxisMemory start = free.law;
  start.m = 1;
  MemoryFit fit = fit_memory(runs, start, {true, false, true});
  add_run_intervals(runs, fit);
  return fit;
}

bool tells_apart(const MemoryFit& at_once, const MemoryFit& carried) {
  std::vector<double> differences;
  for (std::size_t s = 0; s < at_once.cost_without.size(); ++s)
    differences.push_back(carried.cost_without[s] - at_once.cost_without[s]);
  if (differences.size() < 3) return false;
  const double factor = statistics::student_quantile_99(static_cast<int>(differences.size()) - 1);
  return carried.cost - at_once.cost > factor * std::sqrt(statistics::jackknife_variance(differences));
}

std::vector<CarriedRhoTrial> carried_trials(const Runs& runs, const MemoryFit& at_once) {
  std::vector<CarriedRhoTrial> trials{{at_once, false}};
  for (const double c_rho : {30.0, 100.0, 300.0, 1000.0}) {
    AxisMemory start = at_once.law;
    start.c_rho = c_rho;
    const MemoryFit fit = fit_memory(runs, start, {true, false, true});
    trials.push_back({fit, tells_apart(at_once, fit)});
  }
  return trials;
}

/// The one of the carried rho that fits best.
AxisMemory solvable_law(const std::vector<CarriedRhoTrial>& trials) {
  const auto best = std::min_element(trials.begin() + 1, trials.end(),
                                     [](const auto& a, const auto& b) { return a.fit.cost < b.fit.cost; });
  return best->fit.law;
}

std::vector<DilationShare> dilation_shares(std::span<const RunEvidence> runs) {
  std::vector<DilationShare> shares;
  for (int k = -11; k < -2; ++k) {
    DilationShare share{std::pow(10, 0.5 * k), std::pow(10, 0.5 * (k + 1)), {}, {}};
    for (const RunEvidence& run : runs)
      for (const LawBlock& block : run.amount_blocks) {
        if (block.x == 0 || block.friction.I < share.I_from || block.friction.I >= share.I_to) continue;
        DilationShare::Half& half = block.x < 0 ? share.upstream : share.downstream;
        ++half.points;
        half.mu += block.friction.mu;
        half.dilatancy += block.dilatancy;
      }
    for (DilationShare::Half* half : {&share.upstream, &share.downstream}) {
      const auto count = static_cast<double>(half->points);
      half->mu /= count;
      half->dilatancy /= count;
    }
    if (share.upstream.points > 0 || share.downstream.points > 0) shares.push_back(share);
  }
  return shares;
}

void tell_of_coefficients(const MemoryCalibration& found, std::vector<std::string>& untold) {
  constexpr double close = 0.7;
  const MemoryFit& free = found.free;
  if (!free.converged || !found.bounded.converged)
    untold.push_back("the fit did not settle: c, m and chi are not determined by these runs");
  const char* pairs[] = {"c and m", "c and chi", "m and chi"};
  for (std::size_t pair = 0; pair < 3; ++pair)
    if (std::abs(free.correlation[pair]) > close)
      untold.push_back(
          fmt::format("{} move together (correlation {:+.2f} over the sectors): their "
                      "intervals are not independent",
                      pairs[pair], free.correlation[pair]));
  if (free.law.m > 1)
    untold.push_back(
        fmt::format("m: {:.2f} +- {:.2f} fits best; a law whose stress does no negative work has m <= 1, "
                    "which is held (cost {:+.1f} %)",
                    free.law.m, free.ci99_sectors[memory_m], 100 * (found.bounded.cost / free.cost - 1)));
}

void tell_of_trials(const MemoryCalibration& found, std::vector<std::string>& untold) {
  std::string alike_rho;
  for (const CarriedRhoTrial& trial : std::span(found.carried).subspan(1))
    if (!trial.told_apart)
      alike_rho += fmt::format(" {:g} (cost {:+.0f} %),", *trial.fit.law.c_rho,
                               100 * (trial.fit.cost / found.bounded.cost - 1));
  if (alike_rho.empty()) {
    untold.push_back(
        "c_rho: rho at once fits better than each value tried; the best of them is taken, since a "
        "flow needs one");
  } else {
    alike_rho.pop_back();
    untold.push_back(fmt::format("c_rho: not distinguished from rho at once with 99 %:{}; {:g} is taken",
                                 alike_rho, *found.law.c_rho));
  }
  const LeadTrial& best = best_of(found.leads);
  std::string alike;
  for (const LeadTrial& trial : found.leads)
    if (&trial != &best && trial.cost < 1.05 * best.cost)
      alike += fmt::format(" {:g} to {:g},", trial.I_low, trial.I_high);
  if (!alike.empty()) {
    alike.pop_back();
    untold.push_back(fmt::format("chi(I): a fall over I ={} fits within 5 % of the best", alike));
  }
}

std::vector<std::string> what_is_untold(const MemoryCalibration& found, std::size_t runs) {
  std::vector<std::string> untold;
  tell_of_coefficients(found, untold);
  tell_of_trials(found, untold);
  untold.push_back(
      fmt::format("|s|/p below I = {:.1e} and above {:.1e}: no point; the table goes on straight "
                  "in ln I",
                  found.amount.I_min, found.amount.I_max));
  if (const std::size_t held = held_intervals(found.amount.form, found.amount.fit.law); held > 0)
    untold.push_back(
        fmt::format("|s|/p: {} of {} intervals of the table are as flat as a well-posed law can be; "
                    "the points require less",
                    held, found.amount.form.knots.size() - 1));
  if (runs < 2) untold.push_back("one run alone: what differs from run to run is not known");
  if (*std::min_element(found.from_displacements.begin(), found.from_displacements.end()) < 0.3)
    untold.push_back(
        "maps without motion from displacements: the strain rate of the bed is that of velocities, "
        "with more noise; measure the runs anew");
  return untold;
}

// A file with such a law would be refused by whoever reads it.
void refuse_what_no_law_has(const AmountMemory& law) {
  if (law.swelling > 0 && std::abs(law.lag) <= 1) return;
  throw InputError(fmt::format(
      "--amount: the runs show a swelling of {:.3g} and a lag of {:.3g} (allowed: a swelling above 0, a "
      "lag "
      "between -1 and 1): the amount of their stress does not remember as the law says; leave --amount out",
      law.swelling, law.lag));
}

}  // namespace

CalibratedLaw amount_law(std::span<const RunEvidence> runs, int draws) {
  std::vector<std::vector<FrictionPoint>> points;
  std::vector<double> I;
  for (const RunEvidence& run : runs) {
    points.push_back(amounts(run.amount_blocks));
    for (const FrictionPoint& point : points.back()) I.push_back(point.I);
  }
  if (I.size() < least_amounts)
    throw InputError(
        fmt::format("--memory, --nonlocal: the amount of the stress is known in {} blocks of the maps alone "
                    "(needed: {}); take longer runs or a larger drum",
                    I.size(), least_amounts));
  return calibrated(points, {.kind = FormKind::table, .knots = table_knots(I)}, draws);
}

double DilationShare::slope() const {
  return (upstream.mu - downstream.mu) / (upstream.dilatancy - downstream.dilatancy);
}

MemoryLaw measured_memory(const MemoryCalibration& found) {
  const CalibratedLaw& table = found.remembered ? found.remembered->table : found.amount;
  const auto amount = measured_friction(table.form, table.fit.law, {}, 0, 0);
  const AxisMemory& law = found.law;
  MemoryLaw memory{law.c,     law.m,      law.chi * 180 / std::numbers::pi,       law.c_rho.value(),
                   law.I_low, law.I_high, std::get<TabulatedLaw>(amount).points()};
  if (found.remembered) memory.amount = found.remembered->law;
  return memory;
}

MemoryCalibration memory_calibration(std::span<const RunEvidence> runs, std::span<const RunEvidence> held_out,
                                     const CalibratedLaw& amount_over_I, std::optional<double> own_weight) {
  MemoryCalibration found;
  found.amount = amount_over_I;
  found.bed_line = fitted_bed_line(runs);
  const FormCurve amount = found.amount.curve();
  const Runs paths = paths_of(runs, amount, own_weight.value_or(0), &found.from_displacements);
  require_bed(paths);
  found.leads = lead_trials(paths);
  AxisMemory start = first_guess;
  start.I_low = best_of(found.leads).I_low;
  start.I_high = best_of(found.leads).I_high;
  found.free = fit_memory(paths, start, {true, true, true});
  add_run_intervals(paths, found.free);
  found.bed_alone = bed_fit(paths);
  found.bounded = bounded_fit(paths, found.free);
  found.carried = carried_trials(paths, found.bounded);
  found.law = solvable_law(found.carried);
  for (const PathsOfRun& run : paths) found.scores.push_back(memory_score(run, found.law));
  const Runs others = paths_of(held_out, amount, own_weight.value_or(0), nullptr);
  for (const PathsOfRun& run : others) found.predictions.push_back(memory_score(run, found.law));
  if (own_weight) {
    found.remembered = fit_amount(paths, others, measured_memory(found), found.amount, *own_weight);
    refuse_what_no_law_has(found.remembered->law);
  }
  const double radius = needed_number(runs.front().map->header, &RunHeader::drum_radius, "maps.h5");
  found.arcs = axes_on_arcs(paths, found.law, radius);
  found.dilation = dilation_shares(runs);
  found.untold = what_is_untold(found, runs.size());
  return found;
}

}  // namespace drumlin::coupling
