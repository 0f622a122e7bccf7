#pragma once
// Residual of a contact problem: how far impulses are from solving it (docs/conventions.md, "Accuracy of a
// contact solve"). It follows from the impulses alone, through u = W r + q, and shares nothing with the
// solvers, so that all of them are measured alike.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "particles/contact/contact_problem.hpp"
#include "particles/contact/solution.hpp"
#include "particles/contact/squared_errors.hpp"
#include "particles/parallel/parallel_loops.hpp"
#include "particles/parallel/work_memory.hpp"

namespace drumlin::particles {

/// With e_a = |r_a - P_K(r_a - rho_a (u_a + mu_a |u_t,a| n))| / rho_a and rho_a = 1 / lambda_max(W_aa), a
/// velocity; with a couple the shift of u_n is mu |u_t| + mu_r |u_r|. Where one of mu and mu_r is above 1 the
/// shift would count an error of u_t so many times: there the parts are projected in turn, r_n on r_n >= 0,
/// then the others on the bounds that this gives.
struct ContactResidual {
  double rms = 0;          ///< rms of e_a over the contacts / rms of all entries of q: "residual" in files
  double max = 0;          ///< largest e_a / rms of all entries of q: "residual_max" in files
  double penetration = 0;  ///< max(-u_n) h, at least 0; in d inside the project
  /// h sum r_n max(-u_n, 0) / sum |p_b| over the bodies, with their impulses p = H^T r: the mean
  /// displacement, in d inside the project, by which a step lets bodies sink against what carries them. Walls
  /// that contacts push and the sides of a cell under pressure are bodies, too: grains between them carry a
  /// load without one of their own. In a chain of n contacts that all miss by the same, n/2 times what one of
  /// them misses. NaN of a problem without bodies.
  double sinking = 0;
};

/// e_a^2 of contact a of a problem.
template <class Problem>
double squared_error(const Problem& problem, int a, std::span<const double> r, std::span<const double> u) {
  constexpr int dim = Problem::dim;
  using Law = typename Problem::Law;
  return squared_error<Law>(problem.W.largest_eigenvalue(a), problem.mu.data() + Law::coefficients * a,
                            r.data() + dim * a, u.data() + dim * a);
}

/// Sum of squares, in four parts: one part would wait for itself.
inline double squared_norm(std::span<const double> entries) {
  std::array<double, 4> parts{};
  std::size_t k = 0;
  for (; k + 4 <= entries.size(); k += 4)
    for (std::size_t part = 0; part < 4; ++part) parts[part] += entries[k + part] * entries[k + part];
  for (; k < entries.size(); ++k) parts[k % 4] += entries[k] * entries[k];
  return (parts[0] + parts[1]) + (parts[2] + parts[3]);
}

/// Size of the impulse that gave a body at rest its velocity; 0 of what does not move.
template <class Body>
double impulse_of(const Body& body) {
  if (!(body.inverse_mass > 0)) return 0;
  const auto x = static_cast<double>(body.x), z = static_cast<double>(body.z);
  return std::sqrt(x * x + z * z) / static_cast<double>(body.inverse_mass);
}

/// Sum over the bodies of the sizes of the impulses that gave them these velocities; NaN if it holds no
/// bodies.
template <class State>
double summed_impulses(const State& bodies, ParallelLoops& loops) {
  if constexpr (requires(typename State::value_type body) { body.inverse_mass; })
    return loops.sum(bodies.size(), [&](std::size_t begin, std::size_t end) {
      double sum = 0;
      for (std::size_t b = begin; b < end; ++b) sum += impulse_of(bodies[b]);
      return sum;
    });
  else
    return std::numeric_limits<double>::quiet_NaN();
}

/// What the residual adds up over some contacts.
struct ResidualSums {
  double squares = 0, largest = 0, lowest_u_n = 0, complementarity_violation = 0;

  void add(double squared_error, double r_n, double u_n) {
    squares += squared_error;
    // A comparison that a NaN fails would hide it.
    if (!(squared_error <= largest)) largest = squared_error;
    lowest_u_n = std::min(lowest_u_n, u_n);
    complementarity_violation += r_n * ((std::abs(u_n) - u_n) / 2);  // max(0, -u_n), without a branch
  }
  void add(const ResidualSums& more) {
    squares += more.squares;
    if (!(more.largest <= largest)) largest = more.largest;
    lowest_u_n = std::min(lowest_u_n, more.lowest_u_n);
    complementarity_violation += more.complementarity_violation;
  }
};

/// Whether W is that of discs.
template <class Problem>
constexpr bool of_discs = requires(const Problem& problem) {
  problem.W.inverse_mass;
};

/// e_a^2 of contacts from `first` on; on vectors where contacts of a plain law push nothing but discs.
template <class Problem>
void set_squared_errors(const Problem& problem, std::size_t first, std::span<const double> r,
                        std::span<const double> u, std::span<double> errors) {
  constexpr std::size_t dim = Problem::dim;
  using Law = typename Problem::Law;
  if constexpr (of_discs<Problem> && is_plain<Law>)
    if (!problem.W.coupled())
      return set_squared_errors<Law>(Problem::Delassus::largest_in_W_nn,
                                     problem.W.inverse_W_nn.data() + first,
                                     problem.mu.data() + Law::coefficients * first, r.data() + dim * first,
                                     u.data() + dim * first, errors);
  for (std::size_t k = 0; k < errors.size(); ++k)
    errors[k] = squared_error(problem, static_cast<int>(first + k), r, u);
}

/// What the residual adds up over contacts `begin` to `end`. set(begin, end) is called for one part of them
/// after the other, and sets its velocities u before they are read.
template <class Problem, class Set>
ResidualSums residual_sums(const Problem& problem, std::size_t begin, std::size_t end,
                           std::span<const double> r, std::span<const double> u, Set set) {
  constexpr std::size_t dim = Problem::dim, some = 128;
  ResidualSums sums;
  std::array<double, some> errors;
  for (; begin < end; begin += some) {
    const std::size_t count = std::min(some, end - begin);
    set(begin, begin + count);
    set_squared_errors(problem, begin, r, u, std::span(errors).first(count));
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t n = dim * (begin + k);
      sums.add(errors[k], r[n], u[n]);
    }
  }
  return sums;
}

template <class Problem>
ResidualSums residual_sums(const Problem& problem, std::size_t begin, std::size_t end,
                           std::span<const double> r, std::span<const double> u) {
  return residual_sums(problem, begin, end, r, u, [](std::size_t, std::size_t) {});
}

/// What the residual of impulses r adds up; `velocities` receives u = W r + q, and what the bodies do.
template <class Problem>
ResidualSums residual_sums_of(const Problem& problem, std::span<const double> r,
                              Velocities<typename Problem::Delassus>& velocities, ParallelLoops& loops) {
  const auto& W = problem.W;
  auto& bodies = velocities.bodies;
  auto& u = velocities.contacts;
  if constexpr (of_discs<Problem>) {
    W.load(bodies, r, loops);
    resize_closely(u, problem.q.size());
  } else {
    W.velocities(r, problem.q, bodies, u);
  }
  // Part by part, so that a near cache holds the velocities that it has set.
  const auto set = [&](std::size_t begin, std::size_t end) {
    if constexpr (of_discs<Problem>)
      W.velocities_of(static_cast<int>(begin), static_cast<int>(end), problem.q, bodies, u);
  };
  return loops.template combined<ResidualSums>(problem.contacts(), [&](std::size_t begin, std::size_t end) {
    return residual_sums(problem, begin, end, r, u, set);
  });
}

/// Sum of the squares of the entries of q, or of as many entries of its rounding: what residuals refer to.
template <class Problem>
double squared_reference(const Problem& problem, ParallelLoops& loops) {
  const double squares = loops.sum(problem.q.size(), [&](std::size_t begin, std::size_t end) {
    return squared_norm(std::span(problem.q).subspan(begin, end - begin));
  });
  return std::max(squares, problem.rounding * problem.rounding * static_cast<double>(problem.q.size()));
}

/// Residual of impulses r (dim * contacts entries); `velocities` receives those that they cause. A problem
/// without contacts, or with r exact, has residual 0; if every entry of q is zero, and its rounding too, or
/// one infinite, and r does not solve it, infinity. Where no contact closes faster than its rounding, none
/// sinks. The result does not depend on the pool of the loops.
template <class Problem>
ContactResidual residual_of(const Problem& problem, std::span<const double> r,
                            Velocities<typename Problem::Delassus>& velocities, ParallelLoops& loops) {
  const int count = problem.contacts();
  ContactResidual residual;
  const ResidualSums sums = residual_sums_of(problem, r, velocities, loops);
  if (count == 0) return residual;
  const double scale = std::sqrt(squared_reference(problem, loops) / static_cast<double>(problem.q.size()));
  const auto relative = [scale](double e) {
    if (e == 0) return 0.0;
    return scale != 0 && !std::isinf(scale) ? e / scale : e * std::numeric_limits<double>::infinity();
  };
  residual.rms = relative(std::sqrt(sums.squares / count));
  residual.max = relative(std::sqrt(sums.largest));
  residual.penetration = -sums.lowest_u_n * problem.time_step;
  if (sums.complementarity_violation == 0 || sums.lowest_u_n >= -problem.rounding) return residual;
  double carried = summed_impulses(velocities.bodies, loops);
  if constexpr (of_discs<Problem>) carried += problem.W.driven_impulses(velocities.bodies);
  residual.sinking = problem.time_step * sums.complementarity_violation / carried;
  return residual;
}

template <class Problem>
ContactResidual residual_of(const Problem& problem, std::span<const double> r,
                            Velocities<typename Problem::Delassus>& velocities) {
  ParallelLoops alone;
  return residual_of(problem, r, velocities, alone);
}

template <class Problem>
ContactResidual residual_of(const Problem& problem, std::span<const double> r) {
  Velocities<typename Problem::Delassus> velocities;
  return residual_of(problem, r, velocities);
}

/// Residual of a solution; sets its velocities.
template <class Problem>
ContactResidual residual_of(const Problem& problem, Solution<Problem>& solution, ParallelLoops& loops) {
  return residual_of(problem, std::span<const double>(solution.impulses), solution.velocities, loops);
}
template <class Problem>
ContactResidual residual_of(const Problem& problem, Solution<Problem>& solution) {
  ParallelLoops alone;
  return residual_of(problem, solution, alone);
}

}  // namespace drumlin::particles
