#pragma once
// The law at a quadrature point, with or without k: the one place that chooses. Without k nothing of it
// exists in the code that runs. Private to fem/.
#include <span>
#include <type_traits>

#include "continuum/fem/detail/assembly.hpp"
#include "continuum/rheology/turned_law.hpp"
#include "continuum/rheology/well_posedness.hpp"

namespace drumlin::fem {

template <class Law>
struct PlainPointLaw {
  const Law& law;
  StressResponse operator()(const Regularisation& r, const PlaneTensor& D, double p, const PlaneTensor& dual,
                            std::size_t /*point*/) const {
    return stress_response(law, r, D, p, dual);
  }
};

template <class Law>
struct TurnedPointLaw {
  const Law& law;
  const StressRatioLaw& k;
  std::span<const double> turn;  ///< per point
  TurnedResponse operator()(const Regularisation& r, const PlaneTensor& D, double p, const PlaneTensor& dual,
                            std::size_t point) const {
    return turned_response(law, LocalRatio{&k, turn[point]}, r, D, p, dual);
  }
};

/// Calls `visit` with the point law of a problem in this setting; `turn` empty: without k.
template <class Visit>
void with_point_law(const FlowProblem& problem, const StressLaw& law, std::span<const double> turn,
                    Visit&& visit) {
  std::visit(
      [&](const auto& chosen) {
        using Law = std::decay_t<decltype(chosen)>;
        if constexpr (!std::is_same_v<Law, NewtonianLaw>)
          if (!turn.empty()) return visit(TurnedPointLaw<Law>{chosen, problem.turned->k, turn});
        visit(PlainPointLaw<Law>{chosen});
      },
      law);
}

inline double margin(const StressResponse& s) {
  return well_posedness_margin(s.strength, s.rate, magnitude(s.right));
}
inline double margin(const TurnedResponse& s) {
  return well_posedness_margin(TurnedStrength{s.strength, s.across, s.at}, s.rate, magnitude(s.right));
}
inline double ratio_of(const StressResponse&) { return 1; }
inline double ratio_of(const TurnedResponse& s) { return s.at.k; }
/// From the axes of D to those of the stress, rad.
inline double axis_angle(const StressResponse&) { return 0; }
inline double axis_angle(const TurnedResponse& s) {
  return 0.5 * std::atan2(s.across.value, s.strength.value);
}

/// What is told of a point of the flow.
struct PointReport {
  PlaneTensor stress;
  double along = 0;   ///< stress along D, rho0 g d: |tau| without k
  double normal = 0;  ///< the law's sigma_zz: its p without k
  double viscosity = 0;
  double margin = 0;
  double ratio = 1;
  double angle = 0;  ///< rad
};

inline PointReport point_report(const FlowProblem& problem, const Setting& setting, const PlaneTensor& D,
                                double p, std::span<const double> turn, std::size_t point) {
  PointReport report;
  with_point_law(problem, setting.law, turn, [&](const auto& law) {
    const auto s = law(setting.regularisation, D, p, D, point);
    const double ratio = ratio_of(s);
    report = {s.stress,
              s.modulus * magnitude(D),
              2 * s.law_pressure / (1 + ratio),
              0.5 * s.modulus,
              margin(s),
              ratio,
              axis_angle(s)};
  });
  return report;
}

}  // namespace drumlin::fem
