#include "continuum/fem/detail/held_fields.hpp"

#include <deal.II/fe/fe_values.h>

#include <cmath>

#include "continuum/fem/detail/carried_field.hpp"
#include "continuum/fem/detail/cell_shapes.hpp"
#include "continuum/fem/detail/fluidity.hpp"
#include "continuum/fem/detail/point_law.hpp"

namespace drumlin::continuum::fem {
namespace {

void mix_in(const ScalarField* before, double share, ScalarField& field) {
  if (!before || share == 1) return;
  field.values.sadd(share, 1 - share, before->values);
  field.values.update_ghost_values();
}

std::vector<double> exponentials(std::vector<double> values) {
  for (double& value : values) value = std::exp(value);
  return values;
}

}  // namespace

HeldValues held_at(const HeldFields& held, const Discretisation& d, const MeshCell& cell,
                   const std::vector<dealii::Point<2>>& unit_points) {
  HeldValues values;
  if (held.turning) values.turn = turn_at(*held.turning, d, cell, unit_points);
  if (held.beta) values.beta = values_at(*held.beta, cell, unit_points);
  if (held.ln_fluidity) values.fluidity = exponentials(values_at(*held.ln_fluidity, cell, unit_points));
  return values;
}

std::vector<double> local_fluidity(const FlowProblem& problem, const Discretisation& d, const State& state) {
  std::vector<double> g;
  const HeldValues& held = state.held_values();
  with_point_law(problem, problem.law, held, [&](const auto& law) {
    for_each_point(d, state.solution, [&](const PointValues& at, std::size_t point) {
      const auto s = law(problem.regularisation, at.D, at.p, at.D, point);
      const double mu = s.strength.value * (1 + ratio_of(s)) / (2 * s.law_pressure);
      g.push_back(2 * s.rate * (held.fluidity.empty() ? 1 : held.fluidity[point]) / mu);
    });
  });
  return g;
}

FabricSources fabric_sources(const FlowProblem& problem, const Discretisation& d, const State& state,
                             const std::vector<double>& turn, double relaxation) {
  FabricSources sources;
  for_each_point(d, state.solution, [&](const PointValues& at, std::size_t point) {
    const double rate = regularised_rate(at.D, problem.regularisation);
    const LocalRatio local{&problem.turned->k, turn[point]};
    const double p = regularised_pressure(at.p, problem.regularisation).value;
    sources.rate.push_back(2 * relaxation * rate);
    sources.target.push_back(local.turning(local.state(rate, p)).value);
  });
  return sources;
}

std::shared_ptr<const HeldFields> held_from(const FlowProblem& problem, const Discretisation& d,
                                            const State& state, const HeldUpdate& update) {
  const HeldFields* before = state.held.get();
  const double share = update.share;
  auto held = std::make_shared<HeldFields>();
  HeldValues& values = held->at_quadrature;
  if (problem.turned) {
    held->turning = turning_of(problem, d, problem.regularisation.shear_rate, state.solution,
                               before ? before->turning.get() : nullptr, share);
    values.turn = held->turning->at_quadrature;
    if (const auto& fabric = problem.turned->fabric) {
      const FabricSources sources = fabric_sources(problem, d, state, values.turn, fabric->relaxation);
      const auto beta =
          carried_by_flow(problem, d, state.solution, {sources.rate, sources.target}, update.linear_tolerance)
              .field;
      mix_in(before ? before->beta.get() : nullptr, share, *beta);
      values.beta = at_quadrature(*beta, d);
      held->beta = beta;
    }
  }
  if (problem.nonlocal) {
    const auto ln_factor = fluidity_factor(problem, d, problem.nonlocal->length,
                                           local_fluidity(problem, d, state), update.linear_tolerance)
                               .ln_factor;
    mix_in(before ? before->ln_fluidity.get() : nullptr, share, *ln_factor);
    values.fluidity = exponentials(at_quadrature(*ln_factor, d));
    held->ln_fluidity = ln_factor;
  }
  return held;
}

}  // namespace drumlin::continuum::fem
