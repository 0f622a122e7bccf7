#include "coupling/accuracy/particle_sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace drumlin::coupling {
namespace {

constexpr double largest_floor = 0.02;

void add(std::vector<ParticleSettings>& points, const ParticleSettings& one) {
  if (std::find(points.begin(), points.end(), one) == points.end()) points.push_back(one);
}

}  // namespace

std::string name_of(const ParticleSettings& s) {
  return fmt::format("{}-tolerance-{:g}-step-{:g}", s.solver, s.tolerance, s.step_s);
}

const std::vector<std::string>& particle_axes() {
  static const std::vector<std::string> axes = {"solver", "tolerance", "step"};
  return axes;
}

ParticleSettings ParticleSweep::tight(double step_s) const {
  return {reference.solver, reference.tolerance, step_s};
}

ParticleSweep particle_sweep(const ParticleSettings& standard, const std::vector<SweepAxis>& axes,
                             const std::vector<std::string>& known_solvers) {
  ParticleSweep sweep;
  sweep.standard = standard;
  const double tolerance = standard.tolerance, step = standard.step_s;
  std::vector<double> tolerances = {tolerance}, steps = {step};
  if (const auto* axis = find_axis(axes, "tolerance"))
    tolerances = numbers_of(*axis, {10 * tolerance, 3 * tolerance, tolerance, tolerance / 3, tolerance / 10});
  if (const auto* axis = find_axis(axes, "step")) steps = numbers_of(*axis, {2 * step, step, step / 2});
  add(sweep.points, standard);
  for (const double h : steps)
    for (const double t : tolerances) add(sweep.points, {standard.solver, t, h});
  // cpg and reference take minutes where the others take seconds: on request.
  if (const auto* axis = find_axis(axes, "solver"))
    for (const std::string& name :
         names_of(*axis, {"accelerated", "accelerated-double", "nlgs", "nlgs-scalar", "nncg"}, known_solvers))
      for (const double t : tolerances)
        if (t >= 0.3 * tolerance) add(sweep.points, {name, t, step});
  double least = INFINITY, shortest = INFINITY;
  for (const ParticleSettings& p : sweep.points) {
    least = std::min(least, p.tolerance);
    shortest = std::min(shortest, p.step_s);
  }
  sweep.finest = {standard.solver, least, shortest};
  sweep.reference = {"accelerated", least / 3, shortest / 2};
  return sweep;
}

std::size_t last_followed(std::span<const double> field_errors) {
  std::size_t chosen = 0;
  for (std::size_t i = 0; i < field_errors.size(); ++i)
    if (field_errors[i] < largest_floor) chosen = i;
  return chosen;
}

}  // namespace drumlin::coupling
