#pragma once
// Fields that the law takes from the flow beyond D and p, held while Newton's method runs: each is absent
// unless its effect is there. Private to fem/.
#include "continuum/fem/detail/scalar_field.hpp"
#include "continuum/fem/detail/turning.hpp"

namespace drumlin::continuum::fem {

/// One number per point; empty without the effect.
struct HeldValues {
  std::vector<double> turn;      ///< s sgn(W - Omega_D), with k
  std::vector<double> beta;      ///< of the fabric that the material carries
  std::vector<double> fluidity;  ///< g_loc/g, with nonlocal fluidity
};

struct HeldFields {
  std::shared_ptr<const Turning> turning;
  std::shared_ptr<const ScalarField> beta;
  std::shared_ptr<const ScalarField> ln_fluidity;  ///< ln(g_loc/g)
  HeldValues at_quadrature;                        ///< per quadrature point of this rank's cells
};

/// At points of one cell, given by their places in the reference cell.
HeldValues held_at(const HeldFields& held, const Discretisation& d, const MeshCell& cell,
                   const std::vector<dealii::Point<2>>& unit_points);

struct State;

struct HeldUpdate {
  double share = 1;  ///< of the new fields; the rest is what `state` held
  double linear_tolerance = 1e-6;
};
/// Whether the problem has any of this.
inline bool holds_fields(const FlowProblem& problem) { return problem.turned || problem.nonlocal; }
/// From the flow of `state`, which was found with what that holds. Collective; throws NotConvergedError where
/// a linear solve misses its tolerance.
std::shared_ptr<const HeldFields> held_from(const FlowProblem& problem, const Discretisation& d,
                                            const State& state, const HeldUpdate& update = {});

/// g_loc = 2 |D| (g_loc/g)/mu of a flow, per quadrature point of this rank's cells.
std::vector<double> local_fluidity(const FlowProblem& problem, const Discretisation& d, const State& state);

/// Sources of the fabric's transport per quadrature point: rate 2 c |D|, target turn (k - 1)/(k + 1).
struct FabricSources {
  std::vector<double> rate, target;
};
FabricSources fabric_sources(const FlowProblem& problem, const Discretisation& d, const State& state,
                             const std::vector<double>& turn, double relaxation);

}  // namespace drumlin::continuum::fem
