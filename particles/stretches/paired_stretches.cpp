#include "particles/stretches/paired_stretches.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/basics/no_value.hpp"
#include "coupling/core/machine/own_costs.hpp"
#include "coupling/core/statistics/quantiles.hpp"
#include "coupling/core/statistics/resampling.hpp"
#include "particles/stretches/stretch.hpp"

namespace drumlin::particles {
namespace {

/// The scene with one stage more: the last one again, as long as the stretch, with these settings.
Scene prolonged(const Scene& scene, double seconds, double step_s, double tolerance) {
  Scene longer = scene;
  longer.stages.push_back(scene.stages.back());
  longer.stages.back().snapshots = 0;
  return with_settings(longer, {scene.solver.name, tolerance, step_s, seconds}, stretch_blocks);
}

/// Normal forces at one step: their mean, and the pressure that they make.
struct Forces {
  double mean = no_value, pressure = 0;
};

Forces forces_of(const Simulation& simulation, double time_step) {
  const Bodies& bodies = simulation.state().bodies;
  double area = 0, sum = 0, radius_ratio = 0;
  for (const double radius : bodies.radius) area += std::numbers::pi * radius * radius;
  const auto contacts = simulation.stepper().loaded_contacts();
  for (const SnapshotContact& contact : contacts) {
    const double force = contact.impulse_n / time_step;
    const double r_i = bodies.radius[static_cast<std::size_t>(contact.i)];
    const double r_j = contact.j < 0 ? 0 : bodies.radius[static_cast<std::size_t>(contact.j)];
    sum += force;
    radius_ratio += force * (r_i + r_j);
  }
  return {contacts.empty() ? no_value : sum / static_cast<double>(contacts.size()),
          radius_ratio / (2 * area)};
}

double rms_displacement(const Bodies& from, const Bodies& to) {
  if (from.count() != to.count() || from.count() == 0) return no_value;
  double squares = 0;
  for (std::size_t i = 0; i < from.count(); ++i) {
    const double x = to.x[i] - from.x[i], z = to.z[i] - from.z[i];
    squares += x * x + z * z;
  }
  return std::sqrt(squares / static_cast<double>(from.count()));
}

/// Sums over the steps of one block.
struct BlockSums {
  double energy = 0, force = 0, forces = 0, pressure = 0, overlap = 0;
};

std::array<double, stretch_quantities.size()> means_of(const BlockSums& sums, double steps,
                                                       double displacement) {
  return {sums.energy / steps, sums.forces > 0 ? sums.force / sums.forces : no_value, sums.pressure / steps,
          displacement, sums.overlap / steps};
}

double mean_of(const std::array<double, stretch_blocks>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

}  // namespace

StretchMeans stretch_means(const Scene& scene, const SimulationState& end, double seconds, double step_s,
                           double tolerance, int threads, const std::function<void()>& after_step) {
  StretchMeans result;
  const double begun = own_cpu_seconds();
  Simulation simulation(prolonged(scene, seconds, step_s, tolerance), end, threads);
  const TimePlan::Part& part = simulation.plan().stages.back();
  result.steps = part.steps;
  const std::int64_t steps = part.steps / static_cast<std::int64_t>(stretch_blocks);
  double energy_before = kinetic_energy(end.bodies);
  for (std::size_t block = 0; block < stretch_blocks; ++block) {
    const Bodies before = simulation.state().bodies;
    BlockSums sums;
    for (std::int64_t step = 0; step < steps; ++step) {
      const StepReport report = simulation.step();
      if (report.lost)
        throw NotConvergedError("a grain is lost in a stretch that tells the accuracy of the run");
      after_step();
      result.missed += report.contacts > 0 && report.solve.status != Status::converged;
      // The mean of both ends of a step: sampling leaves no error of the first order of its own.
      const double energy = kinetic_energy(simulation.state().bodies);
      sums.energy += (energy_before + energy) / 2;
      energy_before = energy;
      const Forces forces = forces_of(simulation, part.time_step);
      sums.pressure += forces.pressure;
      sums.overlap += report.overlap.mean;
      if (std::isnan(forces.mean)) continue;
      sums.force += forces.mean;
      sums.forces += 1;
    }
    const auto means =
        means_of(sums, static_cast<double>(steps), rms_displacement(before, simulation.state().bodies));
    for (std::size_t q = 0; q < stretch_quantities.size(); ++q) result.blocks[q][block] = means[q];
  }
  result.cpu_seconds = own_cpu_seconds() - begun;
  return result;
}

StretchChange change_between(const std::array<double, stretch_blocks>& before,
                             const std::array<double, stretch_blocks>& after, double factor) {
  std::array<double, stretch_blocks> difference, without;
  for (std::size_t b = 0; b < stretch_blocks; ++b) difference[b] = after[b] - before[b];
  StretchChange change;
  change.change = mean_of(difference);
  constexpr double blocks = stretch_blocks;
  for (std::size_t b = 0; b < stretch_blocks; ++b)
    without[b] = (blocks * change.change - difference[b]) / (blocks - 1);
  change.ci99 = statistics::student_quantile_99(static_cast<int>(stretch_blocks / 2) - 1) *
                std::sqrt(statistics::jackknife_variance(without));
  change.error_at_most = factor * (std::abs(change.change) + change.ci99);
  return change;
}

PairedStretches paired_stretches(const Scene& scene, const SimulationState& end, double seconds, int threads,
                                 const std::function<void()>& after_step) {
  const double step = scene.stages.back().time_step_s, tolerance = scene.solver.tolerance;
  const auto stretch = [&](double step_s, double to) {
    return stretch_means(scene, end, seconds, step_s, to, threads, after_step);
  };
  const StretchMeans plain = stretch(step, tolerance), finer = stretch(step / 2, tolerance),
                     stricter = stretch(step, tolerance / 3);
  PairedStretches result;
  result.seconds = seconds;
  result.cost = {plain.cpu_seconds, finer.cpu_seconds, stricter.cpu_seconds};
  for (const double cost : result.cost) result.cpu_seconds += cost;
  result.missed = plain.missed + finer.missed + stricter.missed;
  for (std::size_t q = 0; q < stretch_quantities.size(); ++q) {
    const StretchComparison comparison{
        stretch_quantities[q], mean_of(plain.blocks[q]),
        change_between(plain.blocks[q], finer.blocks[q], error_over_step_change),
        change_between(plain.blocks[q], stricter.blocks[q], error_over_solver_change)};
    if (std::isfinite(comparison.value + comparison.step.ci99 + comparison.solver.ci99))
      result.quantities.push_back(comparison);
  }
  return result;
}

}  // namespace drumlin::particles
