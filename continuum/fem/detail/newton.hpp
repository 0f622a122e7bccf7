#pragma once
// Newton's method on one mesh: what the continuation and the steps in time share. Private to fem/.
#include <optional>
#include <string>

#include "continuum/fem/detail/direct_solver.hpp"
#include "continuum/fem/detail/settled_fluidity.hpp"
#include "continuum/fem/detail/solved_level.hpp"
#include "continuum/fem/detail/work_clock.hpp"
#include "continuum/fem/flow_solver.hpp"

namespace drumlin::continuum::fem {

/// One system that is solved to one tolerance.
struct Phase {
  std::string name;
  Setting setting;
  double tolerance = 0;
  bool starts_nearby = false;  ///< from a flow of another mesh or of a problem that differs a little
  bool keeps_dual = false;     ///< the state's; else that of its D
  bool gives_up = false;       ///< where it hardly gets on: another start follows
  bool locally = true;         ///< what few unknowns hold of the residual may settle by itself
};

/// Primal-dual Newton with a line search on the slope; the slope of the surface is one more unknown.
class Newton {
 public:
  Newton(const FlowProblem& problem, const FlowSolverOptions& options, const Discretisation& discretisation,
         int level, double start_seconds, WorkClock& clock, FlowReport& report, const FlowObserver& observer)
      : problem_(problem),
        options_(options),
        d_(discretisation),
        level_(level),
        start_(start_seconds),
        clock_(clock),
        report_(report),
        observer_(observer),
        moment_(surface_moment(problem, d_)),
        system_(d_) {
    report.meshes = level + 1;
    if (problem.frame) frame_moment_ = moment_ * frame_velocity(problem, d_);
    if (d_.has_fluidity()) fluidity_.emplace(problem, d_);
    weight_norm_ = problem.density > 0 ? load(d_, {0, problem.density}).l2_norm() : 0;
  }

  /// Where it fails, the report says which iterations were in vain.
  bool solve(const Phase& phase, State& state);
  /// Prepares corrected(): factors of the tangent at a state. Throws NotConvergedError where it is singular.
  void linearise(const Setting& setting, const State& state);
  /// After one more step with these factors; the residual is of the mesh as it stands now.
  State corrected(const Setting& setting, const State& state);
  /// Whether anything settled by itself in the last solve().
  bool has_settled_locally() const { return has_settled_locally_; }
  /// On any rank.
  bool was_interrupted() const {
    return d_.sum(observer_.interrupted && observer_.interrupted() ? 1 : 0) > 0;
  }

 private:
  struct Step {
    FieldVector solution;
    double theta = 0;
    double linear_residual = 0;
  };
  bool iterate(const Phase& phase, State& state);
  void factorise(const State& state);
  Step step_with_factors(const State& state);
  State without_moment(const State& state) const;
  double solved(const FieldVector& rhs, FieldVector& solution);
  std::optional<Step> newton_step(const Phase& phase, const State& state);
  bool take(const Phase& phase, const Step& step, State& state, IterationReport& line);
  /// True where nothing has to settle.
  bool settle(const Phase& phase, double tolerance, State& state) {
    return !fluidity_ || fluidity_->settle(phase.setting, tolerance, state);
  }
  void record(const IterationReport& line);
  double product(const FieldVector& a, const FieldVector& b) const;
  double slope(const Phase& phase, const State& state, const Step& step, double alpha);
  void settle_locally(const Phase& phase, State& state);
  double relative_residual() const { return system_.residual.l2_norm() / reference_; }

  const FlowProblem& problem_;
  const FlowSolverOptions& options_;
  const Discretisation& d_;
  std::optional<SettledFluidity> fluidity_;  // absent: ln g is none of the unknowns
  int level_;
  double start_;
  WorkClock& clock_;
  FlowReport& report_;
  const FlowObserver& observer_;
  FieldVector moment_;
  System system_;
  DirectSolver& factors_ = system_.kept->factors;
  std::optional<FieldVector> response_;  // of the flow to the slope, with these factors
  double response_error_ = 0;            // true relative residual of its solve
  double frame_moment_ = 0;              // of the velocity that the unknown lacks in a rotating frame
  bool has_settled_locally_ = false;
  double weight_norm_ = 0;
  double reference_ = 1;
};

/// The problem's own law and regularisation, steady and slow.
Setting final_setting(const FlowProblem& problem);

/// Solves one phase from the level's state. Where that fails after local steps, once more without them.
bool run(Newton& newton, const Phase& phase, SolvedLevel& level);

/// Another problem on the mesh of a flow, in the frame of the laboratory: its state, with the problem's
/// velocities on the sides.
std::shared_ptr<SolvedLevel> level_for(const FlowField& start, const FlowProblem& problem);

/// What others look at: in the frame of the laboratory.
FlowField field_of(const std::shared_ptr<SolvedLevel>& level);

}  // namespace drumlin::continuum::fem
