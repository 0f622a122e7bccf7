// The solver `reference`: as accurate as can be had, at any price (declared in contact_solver.hpp).
//
// Proximal steps: r_{k+1} solves the problem with a compliance 1/kappa (in units of W_aa) around r_k. Each is
// a piecewise linear equation for the velocities with one solution nearby even where the impulses are not
// unique, and is solved by a semismooth Newton method; the fixed points are the exact solutions. kappa grows
// as long as Newton converges. What was tried before for the drum at mu = 0.4 and stalls near 5e-4 is listed
// in docs/theory/solvers.md.
#include <algorithm>
#include <cmath>
#include <optional>

#include "particles/contact/problems.hpp"
#include "particles/solver/contact_solver.hpp"
#include "particles/solver/diagonal_entry.hpp"
#include "particles/solver/reference_linear.hpp"

namespace drumlin::particles {
namespace {

constexpr int first_sweeps = 5000;  // of NNCG: beyond, it wanders
constexpr int newton_steps = 40;    // without success by then, kappa was too large
constexpr double first_kappa = 100;
// 1/kappa multiplies the differences that the last digits of r make in u: larger ones lose more than they
// gain.
constexpr double largest_kappa = 1e6;
constexpr double smallest_kappa = 10;
// Proximal steps without a better residual after which NNCG stirs the impulses, and its sweeps.
constexpr int patience = 60, stirring_sweeps = 1000;

double dot(std::span<const double> x, std::span<const double> y) {
  double sum = 0;
  for (std::size_t k = 0; k < x.size(); ++k) sum += x[k] * y[k];
  return sum;
}

template <class Problem>
class ProximalNewton {
  static constexpr int dim = Problem::dim;

 public:
  explicit ProximalNewton(const Problem& problem)
      : problem_(problem), system_(problem.W), zero_(problem.q.size(), 0.0), answers_(problem.contacts()) {}

  /// Impulses of the proximal step from `centre`, nothing when Newton fails. `steps_left` counts down.
  std::optional<std::vector<double>> step(const std::vector<double>& centre, double kappa, int& steps_left) {
    centre_ = &centre;
    kappa_ = kappa;
    std::vector<double> r = centre;
    double fault = evaluate(r);
    // Of the velocities; rounding errors of u come back kappa times.
    const double rounding = 1e-14 * kappa * std::sqrt(std::max(0.0, dot(r, u_) - dot(r, problem_.q)));
    for (int k = 0; k < newton_steps && steps_left-- > 0; ++k) {
      const std::vector<ContactResponse> piece = answers_;
      const std::vector<double> change = system_.solution(piece, difference_);
      if (change.empty()) return {};
      const double length = search(r, change, fault);
      // A whole step that ends on the linear piece where it began has solved it exactly.
      if ((length == 1 && answers_ == piece) || (length == 0 && fault <= rounding)) return answer_;
      if (length == 0) return {};
    }
    return {};
  }

 private:
  /// Answer of each contact to the velocities of r, and how far r is from it, in the norm of kinetic energy.
  double evaluate(const std::vector<double>& r) {
    problem_.W.velocities(r, problem_.q, state_, u_);
    answer_.resize(r.size());
    for (int a = 0; a < problem_.contacts(); ++a) answer(a);
    difference_.resize(r.size());
    for (std::size_t k = 0; k < r.size(); ++k) difference_[k] = r[k] - answer_[k];
    problem_.W.velocities(difference_, zero_, state_, image_);
    return std::sqrt(std::max(0.0, dot(difference_, image_)));
  }

  void answer(int a) {
    ContactResponse& D = answers_[a];
    const double k_n = kappa_ / diagonal_entry(problem_.W, a, 0);
    const double r_n = (*centre_)[dim * a] - k_n * u_[dim * a];
    D.nn = r_n > 0 ? k_n : 0;
    answer_[dim * a] = std::max(0.0, r_n);
    if constexpr (dim == 2) {
      const double k_t = kappa_ / diagonal_entry(problem_.W, a, 1);
      const double r_t = (*centre_)[2 * a + 1] - k_t * u_[2 * a + 1], bound = problem_.mu[a] * answer_[2 * a];
      const bool sticks = std::abs(r_t) < bound;
      D.tt = sticks ? k_t : 0;
      D.tn = sticks ? 0 : std::copysign(problem_.mu[a] * D.nn, r_t);
      answer_[2 * a + 1] = std::clamp(r_t, -bound, bound);
    }
  }

  /// r - t change with the first t of 1, 1/2, 1/4... that makes r less wrong; returns t, 0 if none does.
  double search(std::vector<double>& r, const std::vector<double>& change, double& fault) {
    const std::vector<double> from = r;
    for (double t = 1; t > 1e-4; t /= 2) {
      for (std::size_t k = 0; k < r.size(); ++k) r[k] = from[k] - t * change[k];
      const double now = evaluate(r);
      if (now < (1 - 1e-4 * t) * fault) {
        fault = now;
        return t;
      }
    }
    r = from;
    evaluate(r);
    return 0;
  }

  const Problem& problem_;
  ResponseSystem<typename Problem::Delassus> system_;
  typename Problem::Delassus::State state_;
  std::vector<double> zero_, u_, answer_, difference_, image_;
  std::vector<ContactResponse> answers_;
  const std::vector<double>* centre_ = nullptr;
  double kappa_ = 0;
};

/// Follows the proximal steps, and what they have reached.
template <class Problem>
class ReferenceSolve {
 public:
  ReferenceSolve(const Problem& problem, const StoppingRule& rule, SolverWorkspace<Problem>& work,
                 Solution<Problem>& solution)
      : problem_(problem), rule_(rule), work_(work), solution_(solution), test_(rule) {}

  SolveReport execute() {
    sweep(std::clamp(rule_.max_sweeps / 2, 1, first_sweeps), solution_, best_residual_);
    now_ = solution_.impulses;
    std::optional<ProximalNewton<Problem>> newton;
    if (!stopped()) newton.emplace(problem_);
    double kappa = first_kappa;
    int wait = 0;  // proximal steps before kappa may grow
    while (!stopped()) {
      const int before = rule_.max_sweeps - sweeps_;
      int left = before;
      const auto next = newton->step(now_, kappa, left);
      const int steps = before - std::max(0, left);
      sweeps_ += std::max(steps, 1);  // a step that changes nothing counts, or it might go on for ever
      if (next) {
        extrapolate_and_take(*next);
        if (steps <= 8 && --wait < 0) kappa = std::min(3 * kappa, largest_kappa);
      } else {
        kappa = std::max(kappa / 4, smallest_kappa);
        wait = 2;
      }
      if (++without_progress_ > patience) stir(kappa);
    }
    SolveReport report = test_.report();
    report.residual = residual_of(problem_, solution_);  // also its velocities
    return report;
  }

 private:
  bool stopped() { return test_.ends(sweeps_, best_residual_); }

  /// NNCG from the impulses of a solution.
  void sweep(int sweeps, Solution<Problem>& solution, ContactResidual& residual) {
    StoppingRule rule = rule_;
    rule.max_sweeps = sweeps;
    rule.max_seconds = rule_.max_seconds / 4;
    const SolveReport swept = solve_nncg(problem_, rule, work_, solution);
    sweeps_ += swept.sweeps;
    residual = swept.residual;
  }

  /// NNCG from where the steps are; what it reaches is kept if it is the best.
  void stir(double& kappa) {
    const int left = rule_.max_sweeps - sweeps_;
    if (left > 0) {
      ContactResidual residual;
      trial_.impulses.swap(now_);
      sweep(std::min(left, stirring_sweeps), trial_, residual);
      trial_.impulses.swap(now_);
      keep_if_best(now_, residual);
    }
    kappa = first_kappa;
    without_progress_ = 0;
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
  int sweeps_ = 0, without_progress_ = 0;
  StoppingTest test_;
};

}  // namespace

template <class Problem>
SolveReport solve_reference(const Problem& problem, const StoppingRule& rule, SolverWorkspace<Problem>& work,
                            Solution<Problem>& solution) {
  return ReferenceSolve<Problem>(problem, rule, work, solution).execute();
}

#define DRUMLIN_INSTANTIATE(Problem)                                                                   \
  template SolveReport solve_reference(const Problem&, const StoppingRule&, SolverWorkspace<Problem>&, \
                                       Solution<Problem>&);
DRUMLIN_INSTANTIATE(FrictionlessProblem)
DRUMLIN_INSTANTIATE(CoulombProblem)
DRUMLIN_INSTANTIATE(CoulombSpinProblem)
DRUMLIN_INSTANTIATE(BlockProblem)
#undef DRUMLIN_INSTANTIATE

}  // namespace drumlin::particles
