// The solver `reference`: as accurate as can be had, at any price (declared in any_solver.hpp).
//
// Accelerated sweeps, then plain ones, then proximal steps r_{k+1} around r_k
// (particles/lab/proximal_newton.hpp). The steps go implicitly, over a time kappa, where plain sweeps go
// in times of order one; kappa grows as long as Newton converges. Plain sweeps come between since momentum
// keeps drums at mu = 0.4 near 3e-4: what it feeds grows there. docs/theory/solvers.md has the measurements.
#include <algorithm>
#include <cmath>
#include <optional>

#include "particles/lab/any_solver.hpp"
#include "particles/lab/proximal_newton.hpp"

namespace drumlin::particles {
namespace {

constexpr int first_sweeps = 20000;  // accelerated, and at most as many plain ones after them
constexpr double first_kappa = 100;
// 1/kappa multiplies the differences that the last digits of r make in u: larger ones lose more than they
// gain.
constexpr double largest_kappa = 1e6;
constexpr double smallest_kappa = 10;
constexpr int few_factorisations = 8;  // with so few, a step could have been larger
// Proximal steps without a better residual after which plain sweeps stir the impulses; how many the first
// time, twice as many each further time.
constexpr int patience = 60, first_stirring_sweeps = 200;

/// Follows the proximal steps, and what they have reached.
template <class Problem>
class ReferenceSolve {
 public:
  ReferenceSolve(const Problem& problem, const StoppingRule& rule, SolverWorkspace<Problem>& work,
                 Solution<Problem>& solution)
      : problem_(problem), rule_(rule), work_(work), solution_(solution), test_(rule) {}

  SolveReport execute() {
    const int first = std::clamp(rule_.max_sweeps / 2, 1, first_sweeps);
    best_residual_ = sweep(any_solver<Problem>("accelerated"), first, solution_);
    now_ = solution_.impulses;
    if (!stopped()) stir(std::min(first_sweeps, rule_.max_sweeps / 16));
    std::optional<ProximalNewton<Problem>> newton;
    if (!stopped()) newton.emplace(problem_);
    double kappa = first_kappa;
    int wait = 0;  // proximal steps before kappa may grow
    while (!stopped()) {
      const auto next = newton->step(now_, kappa, [this] { return may_factorise(); });
      if (next) {
        extrapolate_and_take(*next);
        if (newton->factorisations() <= few_factorisations && --wait < 0)
          kappa = std::min(3 * kappa, largest_kappa);
      } else {
        kappa = std::max(kappa / 4, smallest_kappa);
        wait = 2;
      }
      if (++without_progress_ > patience) {
        stir(stirring_sweeps_);
        stirring_sweeps_ = std::min(2 * stirring_sweeps_, first_sweeps);
        kappa = first_kappa;
      }
    }
    SolveReport report = test_.report();
    report.residual = residual_of(problem_, solution_);  // also its velocities
    return report;
  }

 private:
  bool stopped() { return test_.ends(sweeps_, best_residual_); }

  /// Each factorisation counts as a sweep.
  bool may_factorise() {
    if (stopped()) return false;
    ++sweeps_;
    return true;
  }

  /// Sweeps from the impulses of a solution; returns what they reach.
  ContactResidual sweep(ContactSolver<Problem> solver, int sweeps, Solution<Problem>& solution) {
    StoppingRule rule = rule_;
    rule.max_sweeps = sweeps;
    rule.max_seconds = rule_.max_seconds / 8;
    const SolveReport swept = solver(problem_, rule, work_, solution);
    sweeps_ += swept.sweeps;
    return swept.residual;
  }

  /// Plain sweeps from where the steps are; what they reach is kept if it is the best.
  void stir(int sweeps) {
    without_progress_ = 0;
    sweeps = std::min(sweeps, rule_.max_sweeps - sweeps_);
    if (sweeps <= 0) return;
    trial_.impulses.swap(now_);
    const ContactResidual reached = sweep(any_solver<Problem>("nlgs"), sweeps, trial_);
    trial_.impulses.swap(now_);
    keep_if_best(now_, reached);
  }

  ContactResidual residual(const std::vector<double>& r) {
    return residual_of(problem_, std::span<const double>(r), trial_.velocities);
  }

  void keep_if_best(const std::vector<double>& r, const ContactResidual& residual) {
    if (!(residual.rms < best_residual_.rms)) return;
    if (residual.rms < 0.9 * best_residual_.rms) without_progress_ = 0;
    best_residual_ = residual;
    solution_.impulses = r;
  }

  /// Where the impulses are not unique, steps go on in one direction for long: try to go all the way to where
  /// a contact would leave its cone.
  void extrapolate_and_take(const std::vector<double>& next) {
    const double length = length_within_cone(next);
    std::vector<double> beyond = next;
    for (std::size_t k = 0; k < next.size(); ++k) beyond[k] += length * (next[k] - now_[k]);
    now_ = next;
    const ContactResidual of_next = residual(next);
    keep_if_best(now_, of_next);
    if (!(length > 1)) return;
    const ContactResidual of_beyond = residual(beyond);
    if (of_beyond.rms < of_next.rms) now_ = beyond;
    keep_if_best(beyond, of_beyond);
  }

  double length_within_cone(const std::vector<double>& next) const {
    constexpr int dim = Problem::dim;
    double length = 1e6, largest = 0;
    for (const double r : next) largest = std::max(largest, std::abs(r));
    const auto keep_positive = [&](double room, double change) {
      if (change < 0 && room > 1e-12 * largest) length = std::min(length, -room / change);
    };
    for (int a = 0; a < problem_.contacts(); ++a) {
      const double n = next[dim * a], dn = n - now_[dim * a];
      if constexpr (dim == 1) {
        keep_positive(n, dn);
      } else {
        const double t = next[2 * a + 1], dt = t - now_[2 * a + 1], mu = problem_.mu[a];
        keep_positive(mu * n - t, mu * dn - dt);
        keep_positive(mu * n + t, mu * dn + dt);
      }
    }
    return length;
  }

  const Problem& problem_;
  const StoppingRule& rule_;
  SolverWorkspace<Problem>& work_;
  Solution<Problem>& solution_;  ///< the best so far; its residual is best_residual_
  ContactResidual best_residual_;
  Solution<Problem> trial_;
  std::vector<double> now_;
  int sweeps_ = 0, without_progress_ = 0, stirring_sweeps_ = first_stirring_sweeps;
  StoppingTest test_;
};

}  // namespace

template <class Problem>
SolveReport solve_reference(const Problem& problem, const StoppingRule& rule, SolverWorkspace<Problem>& work,
                            Solution<Problem>& solution) {
  return ReferenceSolve<Problem>(problem, rule, work, solution).execute();
}

#define DRUMLIN_INSTANTIATE(Problem, ...)                                                              \
  template SolveReport solve_reference(const Problem&, const StoppingRule&, SolverWorkspace<Problem>&, \
                                       Solution<Problem>&);
DRUMLIN_EACH_PLAIN_PROBLEM(DRUMLIN_INSTANTIATE)
DRUMLIN_INSTANTIATE(BlockProblem)
#undef DRUMLIN_INSTANTIATE

}  // namespace drumlin::particles
