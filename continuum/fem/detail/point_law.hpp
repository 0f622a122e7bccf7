#pragma once
// The law at a quadrature point, with or without k: the one place that chooses. Without k nothing of it
// exists in the code that runs; the spread of fluidity stands behind one test per point. Memory of the axes
// has a law of its own, and so has a fluidity with a threshold. Private to fem/.
#include <span>
#include <type_traits>

#include "continuum/fem/detail/assembly.hpp"
#include "continuum/fem/detail/cell_shapes.hpp"
#include "continuum/rheology/nonlocal_law.hpp"
#include "continuum/rheology/threshold_fluidity.hpp"
#include "continuum/rheology/turned_law.hpp"
#include "coupling/core/law/well_posedness.hpp"

namespace drumlin::continuum::fem {

template <class Law>
struct PlainPointLaw {
  const Law& law;
  const HeldValues& held;
  StressResponse operator()(const Regularisation& r, const PointValues& at, const PlaneTensor& dual,
                            std::size_t point) const {
    if (held.fluidity.empty()) return stress_response(law, r, at.D, at.p, dual);
    return stress_response(NonlocalLaw<Law>{law, held.fluidity[point]}, r, at.D, at.p, dual);
  }
};
/// The start of every flow, which knows of no effect.
template <>
struct PlainPointLaw<NewtonianLaw> {
  const NewtonianLaw& law;
  const HeldValues& held;
  StressResponse operator()(const Regularisation& r, const PointValues& at, const PlaneTensor& dual,
                            std::size_t /*point*/) const {
    return stress_response(law, r, at.D, at.p, dual);
  }
};

template <class Law>
struct TurnedPointLaw {
  const Law& law;
  const StressRatioLaw& k;
  const HeldValues& held;
  TurnedResponse operator()(const Regularisation& r, const PointValues& at, const PlaneTensor& dual,
                            std::size_t point) const {
    if (held.fluidity.empty()) return with_ratio(law, r, at.D, at.p, dual, point);
    return with_ratio(NonlocalLaw<Law>{law, held.fluidity[point]}, r, at.D, at.p, dual, point);
  }

 private:
  template <class Friction>
  TurnedResponse with_ratio(const Friction& mu, const Regularisation& r, const PlaneTensor& D, double p,
                            const PlaneTensor& dual, std::size_t point) const {
    return turned_response(mu, LocalRatio{&k, held.turn[point]}, r, D, p, dual);
  }
};

/// In place of the problem's law.
struct MemoryPointLaw {
  const AxesMemory& effect;
  const HeldValues& held;
  MemoryResponse operator()(const Regularisation& r, const PointValues& at, const PlaneTensor& dual,
                            std::size_t point) const {
    if (held.fluidity.empty()) return with_amount(effect.friction, r, at, dual, point);
    return with_amount(NonlocalLaw<TabulatedLaw>{effect.friction, held.fluidity[point]}, r, at, dual, point);
  }

 private:
  template <class Friction>
  MemoryResponse with_amount(const Friction& mu, const Regularisation& r, const PointValues& at,
                             const PlaneTensor& dual, std::size_t point) const {
    const Remembered& memory = held.memory[point];
    const double m = held.memory_weight;
    if (!effect.law.amount) return memory_response(mu, m, memory, r, at.D, at.p, dual);
    const AmountMemory& amount = *effect.law.amount;
    const FollowedLaw<Friction> followed{mu,
                                         followed_slope(amount),
                                         memory.added,
                                         amount.creep.value_or(Creep{}),
                                         held.spin.empty() ? spin_of(at.motion) : held.spin[point],
                                         amount.own_weight};
    return memory_response(followed, m, memory, r, at.D, at.p, dual);
  }
};

/// mu_loc - mu at a point, its slope by p that by the true one.
template <class Law>
FluidityBalance point_balance(const Law& law, const ThresholdFluidity& effect, const Regularisation& r,
                              const PointValues& at) {
  const RegularisedPressure p = regularised_pressure(at.p, r);
  auto balance = fluidity_balance(law, effect.threshold, at.ln_fluidity, regularised_rate(at.D, r), p.value);
  balance.by_pressure *= p.slope;
  return balance;
}

/// With ln g among the unknowns; the start of every flow is Newtonian, and its ln g follows from it.
struct FluidityPointLaw {
  const StressLaw& law;  ///< of mu_loc
  const ThresholdFluidity& effect;
  const NewtonianLaw* newtonian = nullptr;  ///< null: the stress is that of the fluidity
  FluidityResponse<StressResponse> operator()(const Regularisation& r, const PointValues& at,
                                              const PlaneTensor& dual, std::size_t /*point*/) const {
    FluidityResponse<StressResponse> s{
        newtonian ? stress_response(*newtonian, r, at.D, at.p, dual)
                  : stress_response(FluidityLaw{at.ln_fluidity}, r, at.D, at.p, dual)};
    s.balance = point_balance(law, effect, r, at);
    if (!newtonian) s.by_fluidity = -s.strength.value * dual;
    return s;
  }
};
/// The same with memory of the axes.
struct FluidityMemoryPointLaw {
  const TabulatedLaw& law;
  const ThresholdFluidity& effect;
  const HeldValues& held;
  FluidityResponse<MemoryResponse> operator()(const Regularisation& r, const PointValues& at,
                                              const PlaneTensor& dual, std::size_t point) const {
    FluidityResponse<MemoryResponse> s{memory_response(FluidityLaw{at.ln_fluidity}, held.memory_weight,
                                                       held.memory[point], r, at.D, at.p, dual)};
    s.balance = point_balance(law, effect, r, at);
    s.by_fluidity = (-s.strength.value / s.rho) * (dual + s.weight * s.memory);
    return s;
  }
};

/// Calls `visit` with the point law of a problem that has ln g among its unknowns.
template <class Visit>
void with_fluidity_law(const FlowProblem& problem, const StressLaw& law, const HeldValues& held,
                       Visit&& visit) {
  const ThresholdFluidity& effect = problem.threshold_fluidity.value();
  const auto* newtonian = std::get_if<NewtonianLaw>(&law);
  if (!held.memory.empty() && !newtonian)
    visit(FluidityMemoryPointLaw{problem.memory->friction, effect, held});
  else
    visit(FluidityPointLaw{newtonian ? problem.law : law, effect, newtonian});
}

/// Calls `visit` with the point law of a problem in this setting; `held` has to live as long.
template <class Visit>
void with_point_law(const FlowProblem& problem, const StressLaw& law, const HeldValues& held, Visit&& visit) {
  if (problem.threshold_fluidity) return with_fluidity_law(problem, law, held, visit);
  if (!held.memory.empty() && !std::holds_alternative<NewtonianLaw>(law))
    return visit(MemoryPointLaw{*problem.memory, held});
  std::visit(
      [&](const auto& chosen) {
        using Law = std::decay_t<decltype(chosen)>;
        if constexpr (OfInertialNumber<Law>)
          if (!held.turn.empty()) return visit(TurnedPointLaw<Law>{chosen, problem.turned->k, held});
        visit(PlainPointLaw<Law>{chosen, held});
      },
      law);
}

inline double margin(const StressResponse& s) {
  return well_posedness_margin(s.strength, s.rate, magnitude(s.right));
}
inline double margin(const TurnedResponse& s) {
  return well_posedness_margin(TurnedStrength{s.strength, s.across, s.at}, s.rate, magnitude(s.right));
}
inline double margin(const MemoryResponse& s) { return well_posedness_margin(s); }
inline double ratio_of(const StressResponse&) { return 1; }
inline double ratio_of(const TurnedResponse& s) { return s.at.k; }
inline double across_of(const StressResponse&) { return 0; }
inline double across_of(const TurnedResponse& s) { return s.across.value / s.law_pressure; }
inline double across_of(const MemoryResponse& s) {
  const std::complex<double> n = as_complex(s.right);
  return std::abs(n) > 0 ? (as_complex(s.stress) * std::conj(n)).imag() / (std::abs(n) * s.law_pressure) : 0;
}
/// Stress along D.
inline double along_of(const StressResponse& s, const PlaneTensor& D) { return s.modulus * magnitude(D); }
inline double along_of(const MemoryResponse& s, const PlaneTensor& D) {
  const double rate = magnitude(D);
  return rate > 0 ? 0.5 * contraction(s.stress, D) / rate : 0;
}
inline double viscosity_of(const StressResponse& s) { return 0.5 * s.modulus; }
inline double viscosity_of(const MemoryResponse& s) { return 0.25 * contraction(s.stress, s.right) / s.rate; }
/// From the axes of D to those of the stress, rad.
inline double axis_angle(const StressResponse&) { return 0; }
inline double axis_angle(const TurnedResponse& s) {
  return 0.5 * std::atan2(s.across.value, s.strength.value);
}

inline double axis_angle(const MemoryResponse& s) {
  return 0.5 * std::arg(as_complex(s.stress) * std::conj(as_complex(s.right)));
}

/// What is told of a point of the flow.
struct PointReport {
  PlaneTensor stress;
  double along = 0;   ///< stress along D, rho0 g d: |tau| without k
  double normal = 0;  ///< the law's sigma_zz: its p without k
  double viscosity = 0;
  double margin = 0;
  double ratio = 1;
  double angle = 0;     ///< rad
  double beta = 0;      ///< stress across D over p
  double fluidity = 1;  ///< g_loc/g
  std::optional<Remembered> memory = {};
};

inline PointReport point_report(const FlowProblem& problem, const Setting& setting, const PointValues& at,
                                const HeldValues& held, std::size_t point) {
  PointReport report;
  with_point_law(problem, setting.law, held, [&](const auto& law) {
    const auto s = law(setting.regularisation, at, at.D, point);
    const double ratio = ratio_of(s);
    report = {s.stress,        along_of(s, at.D), 2 * s.law_pressure / (1 + ratio),
              viscosity_of(s), margin(s),         ratio,
              axis_angle(s),   across_of(s),      held.fluidity.empty() ? 1 : held.fluidity[point]};
  });
  if (!held.memory.empty()) report.memory = held.memory[point];
  return report;
}

}  // namespace drumlin::continuum::fem
