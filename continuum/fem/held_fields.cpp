#include "continuum/fem/detail/held_fields.hpp"

#include <deal.II/fe/fe_values.h>

#include <algorithm>
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

std::vector<Remembered> remembered(const std::vector<double>& xx, const std::vector<double>& xz,
                                   const std::vector<double>& rho) {
  std::vector<Remembered> all;
  for (std::size_t i = 0; i < rho.size(); ++i) all.push_back({xx[i], xz[i], rho[i]});
  return all;
}

// What the memory of a flow is, as a whole: m as far as it has risen.
void add_memory(const FlowProblem& problem, const Discretisation& d, const State& state,
                const HeldUpdate& update, HeldFields& held) {
  const double m = update.memory_share * problem.memory->law.m;
  const AxesSources axes = axes_sources(problem, d, state);
  const auto A = axes_carried_by_flow(problem, d, state.solution, {axes.rate, axes.target_xx, axes.target_xz},
                                      update.linear_tolerance);
  const RhoSources sources = rho_sources(problem, d, state, m, *A);
  const auto rho =
      carried_by_flow(problem, d, state.solution, {sources.rate, sources.target}, update.linear_tolerance)
          .field;
  if (update.mixing) update.mixing->mix(d, state.held.get(), *A, *rho);
  held.at_quadrature.memory =
      remembered(at_quadrature(*A, d, 0), at_quadrature(*A, d, 1), at_quadrature(*rho, d));
  held.at_quadrature.memory_weight = m;
  held.axes = A;
  held.rho = rho;
}

}  // namespace

void MemoryMixing::mix(const Discretisation& d, const HeldFields* before, ScalarField& axes,
                       ScalarField& rho) {
  constexpr std::size_t depth = 5;
  if (!before || !before->axes) return;
  Update now{{before->axes->values, before->rho->values}, {axes.values, rho.values}};
  now.change.axes -= now.went_in.axes;
  now.change.rho -= now.went_in.rho;
  const auto dot = [](const Pair& a, const Pair& b) { return a.axes * b.axes + a.rho * b.rho; };
  const auto difference = [](const Pair& a, const Pair& b) {
    Pair result = a;
    result.axes -= b.axes;
    result.rho -= b.rho;
    return result;
  };
  // The combination of past changes that leaves least of the present one.
  const std::size_t n = seen_.size();
  std::vector<Update> steps;
  for (const Update& past : seen_)
    steps.push_back({difference(now.went_in, past.went_in), difference(now.change, past.change)});
  dealii::FullMatrix<double> gram(n, n);
  dealii::Vector<double> product(n), part(n);
  for (std::size_t i = 0; i < n; ++i) {
    product[i] = dot(steps[i].change, now.change);
    for (std::size_t j = 0; j < n; ++j) gram(i, j) = dot(steps[i].change, steps[j].change);
    gram(i, i) *= 1 + 1e-8;  // updates that say the same twice
  }
  if (n > 0) {
    gram.gauss_jordan();
    gram.vmult(part, product);
  }
  const auto combine = [&](FieldVector Pair::*field, FieldVector& next) {
    next = now.went_in.*field;
    next.add(share, now.change.*field);
    for (std::size_t i = 0; i < n; ++i) {
      next.add(-part[i], steps[i].went_in.*field);
      next.add(-share * part[i], steps[i].change.*field);
    }
  };
  combine(&Pair::axes, axes.values);
  combine(&Pair::rho, rho.values);
  bring_into_unit_disc(d, axes);
  for (std::size_t i = 0; i < rho.values.locally_owned_size(); ++i)
    rho.values.local_element(i) = std::max(least_rho, rho.values.local_element(i));
  axes.values.update_ghost_values();
  rho.values.update_ghost_values();
  seen_.push_back(std::move(now));
  if (seen_.size() > depth) seen_.pop_front();
}

HeldValues held_at(const HeldFields& held, const Discretisation& d, const MeshCell& cell,
                   const std::vector<dealii::Point<2>>& unit_points) {
  HeldValues values;
  if (held.turning) values.turn = turn_at(*held.turning, d, cell, unit_points);
  if (held.ln_fluidity) values.fluidity = exponentials(values_at(*held.ln_fluidity, cell, unit_points));
  if (held.axes) {
    values.memory =
        remembered(values_at(*held.axes, cell, unit_points, 0), values_at(*held.axes, cell, unit_points, 1),
                   values_at(*held.rho, cell, unit_points));
    values.memory_weight = held.at_quadrature.memory_weight;
  }
  return values;
}

std::vector<double> local_fluidity(const FlowProblem& problem, const Discretisation& d, const State& state) {
  std::vector<double> g;
  const HeldValues& held = state.held_values();
  with_point_law(problem, problem.law, held, [&](const auto& law) {
    for_each_point(d, state.solution, [&](const PointValues& at, std::size_t point) {
      const auto s = law(problem.regularisation, at, at.D, point);
      const double mu = s.strength.value * (1 + ratio_of(s)) / (2 * s.law_pressure);
      g.push_back(2 * s.rate * (held.fluidity.empty() ? 1 : held.fluidity[point]) / mu);
    });
  });
  return g;
}

AxesSources axes_sources(const FlowProblem& problem, const Discretisation& d, const State& state) {
  const AxesMemory& memory = problem.memory.value();
  AxesSources sources;
  for_each_point(d, state.solution, [&](const PointValues& at, std::size_t) {
    const double rate = regularised_rate(at.D, problem.regularisation);
    const double p = regularised_pressure(at.p, problem.regularisation).value;
    const double phase = memory.turn * memory_turn(memory.law, 2 * rate / std::sqrt(p));
    const std::complex<double> target = std::polar(1 / rate, phase) * as_complex(at.D);
    sources.rate.push_back(2 * memory.law.c * rate);
    sources.target_xx.push_back(target.real());
    sources.target_xz.push_back(target.imag());
  });
  return sources;
}

RhoSources rho_sources(const FlowProblem& problem, const Discretisation& d, const State& state, double m,
                       const ScalarField& axes) {
  const auto xx = at_quadrature(axes, d, 0), xz = at_quadrature(axes, d, 1);
  RhoSources sources;
  for_each_point(d, state.solution, [&](const PointValues& at, std::size_t point) {
    const double rate = regularised_rate(at.D, problem.regularisation);
    sources.rate.push_back(2 * problem.memory->law.c_rho * rate);
    sources.target.push_back(rho_target(m, as_complex(at.D) / rate, {xx[point], xz[point]}));
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
  }
  if (problem.memory) add_memory(problem, d, state, update, *held);
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
