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
                                   const std::vector<double>& rho, const std::vector<double>& added) {
  std::vector<Remembered> all;
  for (std::size_t i = 0; i < rho.size(); ++i)
    all.push_back({xx[i], xz[i], rho[i], added.empty() ? 0 : added[i]});
  return all;
}

// What the memory of a flow is, as a whole: m as far as it has risen. What is added to the amount is whole
// from the first update.
void add_memory(const FlowProblem& problem, const Discretisation& d, const State& state,
                const HeldUpdate& update, HeldFields& held) {
  const MemoryLaw& law = problem.memory->law;
  const double m = update.memory_share * law.m;
  const AxesSources axes = axes_sources(problem, d, state);
  const auto A = axes_carried_by_flow(problem, d, state.solution, {axes.rate, axes.target_xx, axes.target_xz},
                                      update.linear_tolerance);
  const RhoSources sources = rho_sources(problem, d, state, m, *A);
  const auto carried = [&](const std::vector<double>& target) {
    return carried_by_flow(problem, d, state.solution, {sources.rate, target}, update.linear_tolerance).field;
  };
  const auto rho = carried(sources.target);
  std::shared_ptr<ScalarField> added;
  if (law.amount)
    added = carried(
        added_target(problem, d, state, *A, *carried_dilatancy(problem, d, state, update.linear_tolerance)));
  if (update.mixing) update.mixing->mix(d, state.held.get(), *A, *rho, added.get());
  held.at_quadrature.memory =
      remembered(at_quadrature(*A, d, 0), at_quadrature(*A, d, 1), at_quadrature(*rho, d),
                 added ? at_quadrature(*added, d) : std::vector<double>());
  held.at_quadrature.memory_weight = m;
  if (law.amount && law.amount->creep) {
    const double frame = problem.frame ? problem.frame->rotation : 0;
    for_each_point(d, state.solution, [&](const PointValues& at, std::size_t) {
      held.at_quadrature.spin.push_back(spin_of(at.motion) + frame);
    });
  }
  held.axes = A;
  held.rho = rho;
  held.added = added;
}

}  // namespace

void MemoryMixing::mix(const Discretisation& d, const HeldFields* before, ScalarField& axes, ScalarField& rho,
                       ScalarField* added) {
  constexpr std::size_t depth = 5;
  constexpr double usual_friction = 0.2;  // brings `added` to the size of the others
  if (!before || !before->axes || (before->added == nullptr) != (added == nullptr)) return;
  const auto values = [](const ScalarField* field) { return field ? field->values : FieldVector(); };
  Update now{{before->axes->values, before->rho->values, values(before->added.get())},
             {axes.values, rho.values, values(added)}};
  const auto subtract = [added](Fields& a, const Fields& b) {
    a.axes -= b.axes;
    a.rho -= b.rho;
    if (added) a.added -= b.added;
  };
  subtract(now.change, now.went_in);
  const double size = axes.values.l2_norm();
  change_ = size > 0 ? now.change.axes.l2_norm() / size : 0;  // what never sheared remembers nothing
  const auto dot = [added](const Fields& a, const Fields& b) {
    const double both = a.axes * b.axes + a.rho * b.rho;
    return added ? both + a.added * b.added / (usual_friction * usual_friction) : both;
  };
  const auto difference = [&](Fields a, const Fields& b) {
    subtract(a, b);
    return a;
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
  const auto combine = [&](FieldVector Fields::*field, FieldVector& next) {
    next = now.went_in.*field;
    next.add(share, now.change.*field);
    for (std::size_t i = 0; i < n; ++i) {
      next.add(-part[i], steps[i].went_in.*field);
      next.add(-share * part[i], steps[i].change.*field);
    }
  };
  combine(&Fields::axes, axes.values);
  combine(&Fields::rho, rho.values);
  bring_into_unit_disc(d, axes);
  for (std::size_t i = 0; i < rho.values.locally_owned_size(); ++i)
    rho.values.local_element(i) = std::max(least_rho, rho.values.local_element(i));
  axes.values.update_ghost_values();
  rho.values.update_ghost_values();
  if (added) {
    combine(&Fields::added, added->values);
    added->values.update_ghost_values();
  }
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
                   values_at(*held.rho, cell, unit_points),
                   held.added ? values_at(*held.added, cell, unit_points) : std::vector<double>());
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
    const double phase = memory.turn * memory_turn(memory.law, inertial_number(memory.law, rate, p));
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

std::vector<double> added_target(const FlowProblem& problem, const Discretisation& d, const State& state,
                                 const ScalarField& axes, const ScalarField& dilatancy) {
  const AxesMemory& memory = problem.memory.value();
  const AmountMemory& amount = memory.law.amount.value();
  const auto xx = at_quadrature(axes, d, 0), xz = at_quadrature(axes, d, 1),
             psi = at_quadrature(dilatancy, d);
  std::vector<double> target;
  for_each_point(d, state.solution, [&](const PointValues& at, std::size_t point) {
    const double rate = regularised_rate(at.D, problem.regularisation);
    const double I =
        inertial_number(memory.law, rate, regularised_pressure(at.p, problem.regularisation).value);
    const double lag = axes_lag(memory.law, memory.turn, as_complex(at.D) / rate, {xx[point], xz[point]}, I);
    target.push_back(added_friction(amount, memory.friction.friction(I).mu, psi[point], lag) -
                     followed_slope(amount) * std::log(I));
  });
  return target;
}

std::shared_ptr<ScalarField> carried_dilatancy(const FlowProblem& problem, const Discretisation& d,
                                               const State& state, double linear_tolerance) {
  const MemoryLaw& law = problem.memory.value().law;
  const AmountMemory& amount = law.amount.value();
  std::vector<double> ln_I, rate, renewed;
  for_each_point(d, state.solution, [&](const PointValues& at, std::size_t) {
    rate.push_back(regularised_rate(at.D, problem.regularisation));
    const double p = regularised_pressure(at.p, problem.regularisation).value;
    ln_I.push_back(remembered_ln_I(law, inertial_number(law, rate.back(), p)));
  });
  const auto carried = [&](double c, const std::vector<double>& target) {
    renewed.clear();
    for (const double here : rate) renewed.push_back(2 * c * here);
    return carried_by_flow(problem, d, state.solution, {renewed, target}, linear_tolerance).field;
  };
  std::vector<double> target = at_quadrature(*carried(amount.c_nu, ln_I), d);
  for (std::size_t i = 0; i < target.size(); ++i) target[i] = dilatancy_target(amount, ln_I[i], target[i]);
  return carried(amount.c_psi, target);
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
