#pragma once
// Fields that the law takes from the flow beyond D and p, held while Newton's method runs: each is absent
// unless its effect is there. Private to fem/.
#include <deque>
#include <limits>
#include <span>

#include "continuum/fem/detail/scalar_field.hpp"
#include "continuum/fem/detail/turning.hpp"
#include "continuum/rheology/memory_stress.hpp"

namespace drumlin::continuum::fem {

/// One number per point; empty without the effect.
struct HeldValues {
  std::vector<double> turn;        ///< s sgn(W - Omega_D), with k
  std::vector<double> fluidity;    ///< g_loc/g, with nonlocal fluidity
  std::vector<Remembered> memory;  ///< A and rho, with memory of the axes
  double memory_weight = 0;        ///< m, less while it rises
  std::vector<double> spin;        ///< W in the laboratory, with creep; empty: that of the flow, seen there
};

struct HeldFields {
  std::shared_ptr<const Turning> turning;
  std::shared_ptr<const ScalarField> ln_fluidity;  ///< ln(g_loc/g)
  std::shared_ptr<const ScalarField> axes;         ///< A: components xx and xz
  std::shared_ptr<const ScalarField> rho;
  std::shared_ptr<const ScalarField> added;  ///< of FollowedLaw; null: the amount is mu(I)
  HeldValues at_quadrature;                  ///< per quadrature point of this rank's cells
};

/// Anderson's mixing of the memory from one Picard update to the next (J. ACM 12 (1965) 547): the memory that
/// comes out of a flow against the one that went into it, as what was seen in the last updates says. Half of
/// the stress is memory, so that whole updates would swing.
class MemoryMixing {
 public:
  static constexpr double share = 0.6;  ///< of the new memory that is taken where nothing was seen yet
  /// The fields that come next, in place of those that came out. Nothing is mixed where `before` holds no
  /// memory.
  /// `added`: null without.
  void mix(const Discretisation& d, const HeldFields* before, ScalarField& axes, ScalarField& rho,
           ScalarField* added);
  void forget() { seen_.clear(); }
  /// |A that came out - A that went in| over |A|, root mean squares, at the last mix(); infinite before.
  double change() const { return change_; }

 private:
  struct Fields {
    FieldVector axes, rho, added;  ///< `added`: of no size without
  };
  struct Update {
    Fields went_in, change;
  };
  std::deque<Update> seen_;
  double change_ = std::numeric_limits<double>::infinity();
};

/// At points of one cell, given by their places in the reference cell.
HeldValues held_at(const HeldFields& held, const Discretisation& d, const MeshCell& cell,
                   const std::vector<dealii::Point<2>>& unit_points);

struct State;

struct HeldUpdate {
  double share = 1;                ///< of the new fields; the rest is what `state` held. Not of memory
  double memory_share = 1;         ///< of its weight m
  MemoryMixing* mixing = nullptr;  ///< null: the new memory is taken whole
  double linear_tolerance = 1e-6;
};
/// Whether the problem has any of this.
inline bool holds_fields(const FlowProblem& problem) {
  return problem.turned || problem.nonlocal || problem.memory;
}
/// From the flow of `state`, which was found with what that holds. Collective; throws NotConvergedError where
/// a linear solve misses its tolerance.
std::shared_ptr<const HeldFields> held_from(const FlowProblem& problem, const Discretisation& d,
                                            const State& state, const HeldUpdate& update = {});

/// g_loc = 2 |D| (g_loc/g)/mu of a flow, per quadrature point of this rank's cells.
std::vector<double> local_fluidity(const FlowProblem& problem, const Discretisation& d, const State& state);

/// Sources of the memory's transport per quadrature point: rate 2 c |D|, target exp(i t chi(I)) D/|D|.
struct AxesSources {
  std::vector<double> rate, target_xx, target_xz;
};
AxesSources axes_sources(const FlowProblem& problem, const Discretisation& d, const State& state);

/// Sources of rho at weight m with the axes at hand: rate 2 c_rho |D|, target rho_target().
struct RhoSources {
  std::vector<double> rate, target;
};
RhoSources rho_sources(const FlowProblem& problem, const Discretisation& d, const State& state, double m,
                       const ScalarField& axes);

/// The dilatancy psi that the material feels (coupling/core/law/memory_law.hpp); the memory has to have an
/// AmountMemory. Collective; throws NotConvergedError as held_from().
std::shared_ptr<ScalarField> carried_dilatancy(const FlowProblem& problem, const Discretisation& d,
                                               const State& state, double linear_tolerance);

/// What `added` tends to, per quadrature point: added_friction() less followed_slope() ln I.
std::vector<double> added_target(const FlowProblem& problem, const Discretisation& d, const State& state,
                                 const ScalarField& axes, const ScalarField& dilatancy);

}  // namespace drumlin::continuum::fem
