#include "particles/distributed/tile_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "particles/contact/residual.hpp"
#include "particles/solver/momentum.hpp"

namespace drumlin::particles {
namespace {

template <class Velocity>
std::array<double, Halo::numbers> numbers_of(const Velocity& v) {
  if constexpr (requires { v.s; })
    return {v.x, v.z, v.s};
  else
    return {v.x, v.z, 0};
}

template <class Velocity>
void set_numbers(Velocity& v, const std::array<double, Halo::numbers>& numbers) {
  v.x = numbers[0], v.z = numbers[1];
  if constexpr (requires { v.s; }) v.s = numbers[2];
}

}  // namespace

template <class Problem>
void TileSolver<Problem>::pack(const Problem& problem, std::span<const double> r) {
  const Delassus& W = problem.W;
  fixed_ = W.fixed();
  contacts_.resize(problem.contacts());
  loops_.each(contacts_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t a = begin; a < end; ++a) {
      Contact& c = contacts_[a];
      c.i = W.i[a], c.j = W.j[a], c.n_x = W.n_x[a], c.n_z = W.n_z[a], c.inverse_W_nn = W.inverse_W_nn[a];
      if constexpr (dim == 2) c.mu = problem.mu[a];
      for (int e = 0; e < dim; ++e) {
        c.q[e] = problem.q[dim * a + e];
        c.r[e] = c.before[e] = r[dim * a + e];
      }
    }
  });
}

template <class Problem>
template <class Work>
void TileSolver<Problem>::each_colour(const TiledContacts& contacts, Halo& halo,
                                      std::vector<Velocity>& bodies, Work work) {
  const auto& tiles = contacts.tiles;
  const auto some = [&](std::size_t begin, std::size_t end) {
    loops_.each_of(static_cast<int>(end - begin), [&](int k) { work(begin + k); });
  };
  std::size_t first = 0;
  for (int colour = 0; colour < 4; ++colour) {
    std::size_t inner = first;
    while (inner < tiles.size() && tiles[inner].colour == colour && tiles[inner].border) ++inner;
    std::size_t end = inner;
    while (end < tiles.size() && tiles[end].colour == colour) ++end;
    some(first, inner);
    halo.start(colour, [&](std::int32_t b) { return numbers_of(bodies[b]); });
    some(inner, end);
    halo.finish(colour, [&](std::int32_t b, const auto& numbers) { set_numbers(bodies[b], numbers); });
    first = end;
  }
}

template <class Problem>
void TileSolver<Problem>::load(const TiledContacts& contacts, Halo& halo) {
  before_ = bodies_;  // at rest
  each_colour(contacts, halo, bodies_, [&](std::size_t t) {
    for (std::int32_t a = contacts.tiles[t].begin; a < contacts.tiles[t].end; ++a) {
      const Contact& c = contacts_[a];
      Velocity &I = bodies_[c.i], &J = bodies_[c.j];
      double p_x = c.n_x * c.r[0], p_z = c.n_z * c.r[0];
      if constexpr (dim == 2) p_x += c.n_z * c.r[1], p_z -= c.n_x * c.r[1];
      I.x += I.inverse_mass * p_x, I.z += I.inverse_mass * p_z;
      if constexpr (spin && dim == 2) I.s -= 2 * I.inverse_mass * c.r[1];
      if (c.j == fixed_) continue;  // which tiles share
      J.x -= J.inverse_mass * p_x, J.z -= J.inverse_mass * p_z;
      if constexpr (spin && dim == 2) J.s -= 2 * J.inverse_mass * c.r[1];
    }
  });
  before_ = bodies_;
}

/// As BodyDelassus::sweep(), from impulses that momentum has carried on by beta.
template <class Problem>
double TileSolver<Problem>::sweep_tile(const TileRange& tile, double beta) {
  double squares = 0;
  for (std::int32_t a = tile.begin; a < tile.end; ++a) {
    Contact& c = contacts_[a];
    Velocity &I = bodies_[c.i], &J = bodies_[c.j];
    const double d_x = I.x - J.x, d_z = I.z - J.z;
    std::array<double, dim> start;
    for (int e = 0; e < dim; ++e) start[e] = c.r[e] + beta * (c.r[e] - c.before[e]);
    c.before = c.r;
    const double u_n = c.q[0] + c.n_x * d_x + c.n_z * d_z;
    c.r[0] = std::max(0.0, start[0] - u_n * c.inverse_W_nn);
    const double dr_n = c.r[0] - start[0];
    squares += dr_n * dr_n;
    double p_x = c.n_x * dr_n, p_z = c.n_z * dr_n, dr_t = 0;
    if constexpr (dim == 2) {
      constexpr double ratio = spin ? 1.0 / 3 : 1.0;  // W_nn / W_tt
      double u_t = c.q[1] + c.n_z * d_x - c.n_x * d_z;
      if constexpr (spin) u_t -= I.s + J.s;
      const double bound = c.mu * c.r[0];
      c.r[1] = std::clamp(start[1] - u_t * (c.inverse_W_nn * ratio), -bound, bound);
      dr_t = c.r[1] - start[1];
      squares += dr_t * dr_t;
      p_x += c.n_z * dr_t, p_z -= c.n_x * dr_t;
      if constexpr (spin) I.s -= 2 * I.inverse_mass * dr_t;
    }
    I.x += I.inverse_mass * p_x, I.z += I.inverse_mass * p_z;
    if (c.j == fixed_) continue;
    J.x -= J.inverse_mass * p_x, J.z -= J.inverse_mass * p_z;
    if constexpr (spin && dim == 2) J.s -= 2 * J.inverse_mass * dr_t;
  }
  return squares;
}

template <class Problem>
double TileSolver<Problem>::total_of_tiles() {
  ExactSum sum;
  for (const double term : of_tile_) sum.add(term);
  ranks_.add(sum.numbers());
  return sum.value();
}

/// All tiles once; returns the sum of the squares of the steps over all ranks.
template <class Problem>
double TileSolver<Problem>::sweep(const TiledContacts& contacts, Halo& halo, double beta) {
  if (beta != 0) {
    loops_.each(bodies_.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t b = begin; b < end; ++b) {
        Velocity &now = bodies_[b], &then = before_[b];
        const Velocity old = now;
        now.x += beta * (now.x - then.x), now.z += beta * (now.z - then.z);
        if constexpr (spin) now.s += beta * (now.s - then.s);
        then = old;
      }
    });
  } else {
    before_ = bodies_;
  }
  each_colour(contacts, halo, bodies_,
              [&](std::size_t t) { of_tile_[t] = sweep_tile(contacts.tiles[t], beta); });
  return total_of_tiles();
}

/// What turns the summed squares of the residuals into the square of the relative one.
template <class Problem>
double TileSolver<Problem>::scale_of(const Problem& problem, const TiledContacts& contacts) {
  for (std::size_t t = 0; t < contacts.tiles.size(); ++t) {
    const TileRange& tile = contacts.tiles[t];
    of_tile_[t] = squared_norm(std::span(problem.q).subspan(dim * tile.begin, dim * (tile.end - tile.begin)));
  }
  const double squares = total_of_tiles();
  return squares > 0 ? dim / squares : 1;
}

/// The summed squares of the residuals of the impulses and velocities as sweeps carry them.
template <class Problem>
double TileSolver<Problem>::estimate(const TiledContacts& contacts) {
  loops_.each_of(static_cast<int>(contacts.tiles.size()), [&](int t) {
    double squares = 0;
    for (std::int32_t a = contacts.tiles[t].begin; a < contacts.tiles[t].end; ++a) {
      const Contact& c = contacts_[a];
      const Velocity &I = bodies_[c.i], &J = bodies_[c.j];
      const double d_x = I.x - J.x, d_z = I.z - J.z;
      std::array<double, dim> u = c.q;
      u[0] += c.n_x * d_x + c.n_z * d_z;
      if constexpr (dim == 2) {
        u[1] += c.n_z * d_x - c.n_x * d_z;
        if constexpr (spin) u[1] -= I.s + J.s;
      }
      const double lambda = (dim == 2 && spin ? 3 : 1) / c.inverse_W_nn;
      squares += squared_error<dim>(lambda, &c.mu, c.r.data(), u.data());
    }
    of_tile_[t] = squares;
  });
  return total_of_tiles();
}

template <class Problem>
ContactResidual TileSolver<Problem>::residual(const Problem& problem, const TiledContacts& contacts,
                                              Halo& halo, Solution<Problem>& solution) {
  const Delassus& W = problem.W;
  auto& [state, u] = solution.velocities;
  const std::span<const double> r = solution.impulses;
  W.rest(state);
  each_colour(contacts, halo, state, [&](std::size_t t) {
    for (std::int32_t a = contacts.tiles[t].begin; a < contacts.tiles[t].end; ++a)
      W.push(state, a, r[dim * a], dim == 2 ? r[dim * a + 1] : 0, W.j[a] != W.fixed());
  });
  u.resize(problem.q.size());
  std::vector<ResidualSums> of_tile(contacts.tiles.size());
  std::vector<double> q_squares(contacts.tiles.size());
  loops_.each_of(static_cast<int>(contacts.tiles.size()), [&](int t) {
    const TileRange& tile = contacts.tiles[t];
    W.velocities_of(tile.begin, tile.end, problem.q, state, u);
    for (std::int32_t a = tile.begin; a < tile.end; ++a)
      of_tile[t].add(squared_error(problem, a, r, u), r[dim * a], u[dim * a]);
    q_squares[t] =
        squared_norm(std::span(problem.q).subspan(dim * tile.begin, dim * (tile.end - tile.begin)));
  });
  // Squares, q, let through, summed impulses, and the number of contacts.
  std::array<ExactSum, 4> sums;
  ResidualSums all;
  for (std::size_t t = 0; t < of_tile.size(); ++t) {
    sums[0].add(of_tile[t].squares), sums[1].add(q_squares[t]), sums[2].add(of_tile[t].let_through);
    all.add(of_tile[t]);
  }
  for (std::size_t b = 0; b + 1 < state.size(); ++b)
    if (contacts.counts_here[b])
      sums[3].add(std::sqrt(state[b].x * state[b].x + state[b].z * state[b].z) / state[b].inverse_mass);
  std::vector<std::int64_t> numbers{problem.contacts()};
  for (auto& sum : sums) numbers.insert(numbers.end(), sum.numbers().begin(), sum.numbers().end());
  ranks_.add(numbers);
  for (std::size_t k = 0; k < sums.size(); ++k)
    std::copy_n(numbers.begin() + 1 + k * ExactSum::size(), ExactSum::size(), sums[k].numbers().begin());
  ContactResidual residual;
  if (numbers[0] == 0) return residual;
  const double squares = sums[0].value(), q = sums[1].value(), let_through = sums[2].value();
  if (!std::isfinite(squares) || !std::isfinite(let_through)) {
    residual.rms = residual.max = std::numeric_limits<double>::quiet_NaN();
    return residual;
  }
  std::array<double, 2> extremes{all.largest, -all.lowest_u_n};
  ranks_.largest(extremes);
  const auto count = static_cast<double>(numbers[0]);
  const double scale = std::sqrt(q / (dim * count));
  const auto relative = [scale](double e) {
    return e == 0 ? 0 : scale != 0 ? e / scale : std::numeric_limits<double>::infinity();
  };
  residual.rms = relative(std::sqrt(squares / count));
  residual.max = relative(std::sqrt(extremes[0]));
  residual.penetration = extremes[1] * problem.time_step;
  residual.sinking = let_through == 0 ? 0 : problem.time_step * let_through / sums[3].value();
  return residual;
}

template <class Problem>
SolveReport TileSolver<Problem>::solve(const Problem& problem, const TiledContacts& contacts, Halo& halo,
                                       const StoppingRule& rule, bool accelerated,
                                       Solution<Problem>& solution) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  constexpr double hope = 2;      // times the tolerance: a residual that is looked for
  constexpr int most_unseen = 3;  // looks left out in turn
  StoppingTest test(rule);
  std::vector<double>& r = solution.impulses;
  r.resize(problem.q.size());
  of_tile_.assign(contacts.tiles.size(), 0.0);
  pack(problem, r);
  problem.W.rest(bodies_);
  load(contacts, halo);
  const double scale = scale_of(problem, contacts);
  std::array<std::int64_t, 1> count{problem.contacts()};
  ranks_.add(count);
  if (count[0] == 0) {
    (void)test.ends(0, residual(problem, contacts, halo, solution));
    return test.report();
  }
  Momentum momentum(rule.tolerance, static_cast<std::size_t>(count[0]));
  const auto unpack = [&] {
    for (std::size_t a = 0; a < contacts_.size(); ++a)
      for (int e = 0; e < dim; ++e) r[dim * a + e] = contacts_[a].r[e];
  };
  double beta = 0, worth = infinity, best = infinity;
  int unseen = 0;
  for (int sweeps = 1;; ++sweeps) {
    const double steps = sweep(contacts, halo, beta);
    const bool finite = std::isfinite(steps), last = sweeps >= rule.max_sweeps || !finite;
    if (accelerated) beta = momentum.next(steps);
    if (!test.due(sweeps) && finite) continue;
    if (!last && steps > worth && unseen < most_unseen) {
      ++unseen;
      continue;
    }
    unseen = 0;
    const double seen = std::sqrt(estimate(contacts) * scale), fall = hope * rule.tolerance / seen;
    worth = steps * fall * fall;  // residuals fall about as steps do
    if (seen < best) {
      best = seen;
      unpack();
      best_ = r;
    }
    if (!last && seen > rule.tolerance) continue;
    unpack();
    if (!test.ends(sweeps, residual(problem, contacts, halo, solution), finite)) continue;
    if (best < seen && test.report().status != Status::converged) {
      r = best_;
      test.replace(residual(problem, contacts, halo, solution));
    }
    return test.report();
  }
}

template class TileSolver<FrictionlessProblem>;
template class TileSolver<CoulombProblem>;
template class TileSolver<CoulombSpinProblem>;

}  // namespace drumlin::particles
