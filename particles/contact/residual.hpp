#pragma once
// The one judge of every solver, test and cost plot (docs/conventions.md, "Accuracy of a contact solve"). It
// computes u = W r + q from r alone and shares nothing with the solvers.
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "particles/contact/cone.hpp"
#include "particles/contact/contact_problem.hpp"

namespace drumlin {

/// How well impulses solve a problem. With e_a = |r_a - P_K(r_a - rho_a (u_a + mu_a |u_t,a| n))| / rho_a and
/// rho_a = 1 / lambda_max(W_aa), a velocity. With rolling resistance the shift of u_n is mu |u_t| + mu_r
/// |u_r|.
struct Judgement {
  double residual = 0;      ///< rms of e_a over the contacts / rms of all entries of q
  double residual_max = 0;  ///< largest e_a / rms of all entries of q
  double penetration = 0;   ///< max(-u_n) h, at least 0; in d inside the project
};

/// Scratch of the judge, kept between calls so that a step does not allocate.
template <class Delassus>
struct JudgeScratch {
  typename Delassus::State state;
  std::vector<double> u;
};

/// Judges r (dim * contacts entries). A problem without contacts, or with r exact, has residual 0; if every
/// entry of q is zero and r does not solve it, infinity.
template <class Problem>
Judgement judge(const Problem& problem, std::span<const double> r,
                JudgeScratch<typename Problem::Delassus>& scratch) {
  constexpr int dim = Problem::dim;
  const int count = problem.contacts();
  Judgement verdict;
  if (count == 0) return verdict;
  problem.W.velocities(r, problem.q, scratch.state, scratch.u);
  const auto& u = scratch.u;
  double sum = 0, largest = 0, lowest_u_n = 0, q_squares = 0;
  for (const double entry : problem.q) q_squares += entry * entry;
  for (int a = 0; a < count; ++a) {
    const double lambda = problem.W.largest_eigenvalue(a);
    const double rho = 1 / lambda;
    double squares = 0;  // of e / lambda
    if constexpr (dim == 1) {
      const double n = r[a] - std::max(0.0, r[a] - rho * u[a]);
      squares = n * n;
    } else if constexpr (dim == 3) {
      const double mu = problem.mu[2 * a], mu_r = problem.mu[2 * a + 1];
      double n = r[3 * a] - rho * (u[3 * a] + mu * std::abs(u[3 * a + 1]) + mu_r * std::abs(u[3 * a + 2]));
      double t = r[3 * a + 1] - rho * u[3 * a + 1], roll = r[3 * a + 2] - rho * u[3 * a + 2];
      project_on_cone(mu, mu_r, n, t, roll);
      n -= r[3 * a], t -= r[3 * a + 1], roll -= r[3 * a + 2];
      squares = n * n + t * t + roll * roll;
    } else {
      const double u_n = u[2 * a], u_t = u[2 * a + 1], mu = problem.mu[a];
      double n = r[2 * a] - rho * (u_n + mu * std::abs(u_t)), t = r[2 * a + 1] - rho * u_t;
      project_on_cone(mu, n, t);
      n -= r[2 * a], t -= r[2 * a + 1];
      squares = n * n + t * t;
    }
    squares *= lambda * lambda;
    sum += squares;
    // A comparison that a NaN fails would hide it.
    if (!(squares <= largest)) largest = squares;
    lowest_u_n = std::min(lowest_u_n, u[dim * a]);
  }
  const double scale = std::sqrt(q_squares / static_cast<double>(problem.q.size()));
  const auto relative = [scale](double e) {
    return e == 0 ? 0 : scale != 0 ? e / scale : std::numeric_limits<double>::infinity();
  };
  verdict.residual = relative(std::sqrt(sum / count));
  verdict.residual_max = relative(std::sqrt(largest));
  verdict.penetration = -lowest_u_n * problem.time_step;
  return verdict;
}

template <class Problem>
Judgement judge(const Problem& problem, std::span<const double> r) {
  JudgeScratch<typename Problem::Delassus> scratch;
  return judge(problem, r, scratch);
}

}  // namespace drumlin
