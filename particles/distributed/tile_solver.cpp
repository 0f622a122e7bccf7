#include "particles/distributed/tile_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "particles/contact/residual.hpp"
#include "particles/solver/coarse_loads.hpp"
#include "particles/solver/momentum.hpp"
#include "particles/solver/solve_end.hpp"
#include "particles/solver/strip_sweeps.hpp"
#include "particles/solver/two_methods.hpp"

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
template <class Work, class Get, class Set>
void TileSolver<Problem>::work_on(const TileRounds& rounds, Halo& halo, Work work, Get get, Set set) {
  each_colour(
      rounds, loops_, work, [&](int colour) { halo.start(colour, get); },
      [&](int colour) { halo.finish(colour, set); });
}

template <class Problem>
template <class T, class Work>
void TileSolver<Problem>::work_on(const TileRounds& rounds, Halo& halo, Blocks<T>& blocks, Work work) {
  work_on(
      rounds, halo, work, [&](std::int32_t b) { return blocks.numbers(b); },
      [&](std::int32_t b, const auto& numbers) { blocks.set_numbers(b, numbers); });
}

template <class Problem>
ResidualEstimate TileSolver<Problem>::estimate_of_tiles() {
  std::array<ExactSum, 2> sums;
  for (const ResidualEstimate& of_tile : estimates_)
    sums[0].add(of_tile.squares), sums[1].add(of_tile.complementarity_violation);
  ranks_.add(sums);
  std::array<double, 1> closing{0};
  for (const ResidualEstimate& of_tile : estimates_) closing[0] = std::max(closing[0], -of_tile.lowest_u_n);
  ranks_.largest(closing);
  return {sums[0].value(), sums[1].value(), -closing[0]};
}

template <class Problem>
template <class T>
double TileSolver<Problem>::summed_impulses(const TiledContacts& contacts, const Blocks<T>& blocks) {
  ExactSum impulses;
  impulses.add_terms(contacts.counts_here.size(), [&, bodies = blocks.bodies()](std::size_t b) {
    return contacts.counts_here[b] ? impulse_of(bodies[b]) : 0;
  });
  ranks_.add(impulses.numbers());
  return impulses.value();
}

/// What turns the summed squares of the residuals into the square of the relative one.
template <class Problem>
double TileSolver<Problem>::scale_of(const Problem& problem, const TiledContacts& contacts) {
  ExactSum sum;
  for (const TileRange& tile : contacts.tiles)
    sum.add(squared_norm(std::span(problem.q).subspan(dim * tile.begin, dim * (tile.end - tile.begin))));
  ranks_.add(sum.numbers());
  const double squares = sum.value();
  return squares > 0 ? dim / squares : 1;
}

template <class Problem>
void TileSolver<Problem>::set_velocities(const Problem& problem, const TiledContacts& contacts, Halo& halo,
                                         Solution<Problem>& solution) {
  const Delassus& W = problem.W;
  auto& [state, u] = solution.velocities;
  const std::span<const double> r = solution.impulses;
  W.rest(state);
  work_on(
      contacts.order.rounds, halo,
      [&](std::size_t t) {
        for (std::int32_t a = contacts.tiles[t].begin; a < contacts.tiles[t].end; ++a)
          W.push(state, a, r[dim * a], dim == 2 ? r[dim * a + 1] : 0, W.j[a] != W.fixed());
      },
      [&](std::int32_t b) { return numbers_of(state[b]); },
      [&](std::int32_t b, const auto& numbers) { set_numbers(state[b], numbers); });
  u.resize(problem.q.size());
  loops_.each_of(static_cast<int>(contacts.tiles.size()), [&](int t) {
    W.velocities_of(contacts.tiles[t].begin, contacts.tiles[t].end, problem.q, state, u);
  });
}

template <class Problem>
ContactResidual TileSolver<Problem>::residual(const Problem& problem, const TiledContacts& contacts,
                                              Halo& halo, Solution<Problem>& solution) {
  set_velocities(problem, contacts, halo, solution);
  const auto& [state, u] = solution.velocities;
  const std::span<const double> r = solution.impulses;
  std::vector<ResidualSums> of_tile(contacts.tiles.size());
  std::vector<double> q_squares(contacts.tiles.size());
  loops_.each_of(static_cast<int>(contacts.tiles.size()), [&](int t) {
    const TileRange& tile = contacts.tiles[t];
    of_tile[t] = residual_sums(problem, tile.begin, tile.end, r, u);
    q_squares[t] =
        squared_norm(std::span(problem.q).subspan(dim * tile.begin, dim * (tile.end - tile.begin)));
  });
  // Squares, q, let through, summed impulses.
  std::array<ExactSum, 4> sums;
  ResidualSums all;
  for (std::size_t t = 0; t < of_tile.size(); ++t) {
    sums[0].add(of_tile[t].squares), sums[1].add(q_squares[t]),
        sums[2].add(of_tile[t].complementarity_violation);
    all.add(of_tile[t]);
  }
  sums[3].add_terms(contacts.counts_here.size(),
                    [&](std::size_t b) { return contacts.counts_here[b] ? impulse_of(state[b]) : 0; });
  const std::int64_t contacts_of_all = ranks_.add(sums, problem.contacts());
  ContactResidual residual;
  if (contacts_of_all == 0) return residual;
  const double squares = sums[0].value(), q = sums[1].value(), complementarity_violation = sums[2].value();
  if (!std::isfinite(squares) || !std::isfinite(complementarity_violation)) {
    residual.rms = residual.max = std::numeric_limits<double>::quiet_NaN();
    return residual;
  }
  std::array<double, 2> extremes{all.largest, -all.lowest_u_n};
  ranks_.largest(extremes);
  const auto count = static_cast<double>(contacts_of_all);
  const double scale = std::sqrt(q / (dim * count));
  const auto relative = [scale](double e) {
    return e == 0 ? 0 : scale != 0 ? e / scale : std::numeric_limits<double>::infinity();
  };
  residual.rms = relative(std::sqrt(squares / count));
  residual.max = relative(std::sqrt(extremes[0]));
  residual.penetration = extremes[1] * problem.time_step;
  residual.sinking =
      complementarity_violation == 0 ? 0 : problem.time_step * complementarity_violation / sums[3].value();
  return residual;
}

template <class Problem>
template <class T>
void TileSolver<Problem>::correct_loads(const Problem& problem, const TiledContacts& contacts, Halo& halo,
                                        bool first, std::int64_t contacts_of_all, Blocks<T>& blocks) {
  ++corrections_;
  if (first) coarse_.lay_out(problem, contacts, contacts_of_all, blocks);
  if (coarse_.scale(contacts, halo, blocks)) load_bodies(contacts, halo, blocks);
}

template <class Problem>
template <class T>
void TileSolver<Problem>::load_bodies(const TiledContacts& contacts, Halo& halo, Blocks<T>& blocks) {
  blocks.rest(loops_);
  work_on(contacts.order.rounds, halo, blocks, [&](std::size_t t) { blocks.load(t); });
  blocks.start();
}

/// One part of a wave: a phase of sweep s on a strip. A thread does it alone.
template <class Problem>
template <class T>
void TileSolver<Problem>::sweep_part(const TileOrder& order, const Wave<T>& wave, int s, int strip, int phase,
                                     Blocks<T>& blocks) {
  const auto [begin, end] = order.strips[strip].phases[phase];
  if (phase == 0) begin_sweep(order.strips[strip], wave, s, blocks);
  for (std::int32_t t = begin; t < end; ++t) squares_[s][t] = blocks.sweep(t, wave.betas[s], wave.how);
}

/// What a sweep does to a strip before its contacts.
template <class Problem>
template <class T>
void TileSolver<Problem>::begin_sweep(const TileStrip& strip, const Wave<T>& wave, int s, Blocks<T>& blocks) {
  if (wave.how != SweepExtrapolation::none) blocks.go_on(strip, wave.betas[s]);
}

/// Takes several sweeps. Where a strip's neighbours allow it they go through the strips together
/// (sweep_wave.hpp); then the rest follows sweep by sweep and colour by colour, with messages. Where shares
/// of strips end decides only which of both takes a tile: the result is that of sweeps in turn.
template <class Problem>
template <class T>
void TileSolver<Problem>::take_wave(const TiledContacts& contacts, Halo& halo, const Wave<T>& wave,
                                    Blocks<T>& blocks) {
  const auto& [tiles, order, counts_here, x, z] = contacts;
  std::optional<WavePlan>& plan = plans_[wave.sweeps - 1];
  if (!plan) {
    std::vector<StripShare> shares;
    // One sweep alone gains nothing but the caches of one thread, and what lies inside hides the messages.
    if (wave.sweeps > 1 || (ranks_.count() == 1 && loops_.threads() == 1))
      shares = shares_between_borders(tiles, order, wave.sweeps, loops_.threads());
    plan = wave_plan(tiles, order, std::move(shares), wave.sweeps);
  }
  loops_.each_of(static_cast<int>(plan->shares.size()), [&](int k) {
    const StripShare& share = plan->shares[k];
    sweep_alone(share, wave.sweeps,
                [&](int s, int strip, int phase) { sweep_part(order, wave, s, strip, phase, blocks); });
  });
  for (int s = 0; s < wave.sweeps; ++s) {
    const auto& [strips, rounds] = plan->left[s];
    if (ranks_.count() == 1 && plan->left[s].nothing()) continue;
    loops_.each_of(static_cast<int>(strips.size()),
                   [&](int k) { begin_sweep(order.strips[strips[k]], wave, s, blocks); });
    work_on(rounds, halo, blocks,
            [&](std::size_t t) { squares_[s][t] = blocks.sweep(t, wave.betas[s], wave.how); });
  }
}

/// The sums over all ranks of the squared steps of the sweeps of a wave.
template <class Problem>
std::array<double, longest_wave> TileSolver<Problem>::steps_of_wave(int sweeps) {
  std::array<ExactSum, longest_wave> sums;
  for (int s = 0; s < sweeps; ++s)
    for (const double squares : squares_[s]) sums[s].add(squares);
  ranks_.add(std::span(sums).first(sweeps));
  std::array<double, longest_wave> steps{};
  for (int s = 0; s < sweeps; ++s) steps[s] = sums[s].value();
  return steps;
}

/// The loop of particles/solver/strip_sweeps.hpp, with sums over ranks.
template <class Problem>
template <class T>
SolveReport TileSolver<Problem>::sweep_until_done(const Problem& problem, const TiledContacts& contacts,
                                                  Halo& halo, const StoppingRule& rule,
                                                  std::int64_t contacts_of_all, Blocks<T>& blocks,
                                                  bool accelerated, Solution<Problem>& solution) {
  std::vector<double>& r = solution.impulses;
  const auto tiles = static_cast<int>(contacts.tiles.size());
  plans_ = {};
  for (auto& squares : squares_) squares.assign(contacts.tiles.size(), 0.0);
  blocks.pack(problem, contacts.tiles, r, loops_);
  load_bodies(contacts, halo, blocks);
  SolveEnd::Kind kind;
  kind.time_step = problem.time_step, kind.residual_scale = scale_of(problem, contacts);
  kind.how = extrapolation_of(accelerated, contacts_of_all);
  kind.single = sizeof(T) < sizeof(double);
  kind.steep = accelerated && steep_;
  kind.limits_sinking = std::isfinite(rule.sinking);
  SolveEnd end(rule, kind);
  const SweptBlocks swept{[&] {
                            loops_.each_of(tiles, [&](int t) { estimates_[t] = blocks.residual(t); });
                            return estimate_of_tiles();
                          },
                          [&] { return summed_impulses(contacts, blocks); },
                          [&] { loops_.each_of(tiles, [&](int t) { blocks.keep(t); }); },
                          [&](bool kept) {
                            blocks.unpack(problem, kept, r, loops_);
                            return residual(problem, contacts, halo, solution);
                          }};
  Momentum momentum(rule.tolerance, static_cast<std::size_t>(contacts_of_all));
  const int most_at_once = accelerated && contacts_of_all >= least_contacts_of_waves ? longest_wave : 1;
  T beta = 0;

  const bool coarse = accelerated && contacts_of_all >= least_corrected_ && ranks_.any(!contacts.x.empty());
  for (int sweeps = 0, corrected_at = 0;;) {
    if (coarse && sweeps >= corrected_at + sweeps_between_coarse_loads) {
      correct_loads(problem, contacts, halo, corrected_at == 0, contacts_of_all, blocks);
      corrected_at = sweeps;
      beta = 0;
    }
    const int until = end.next_round(sweeps);
    bool finite = true;
    double steps = 0;
    while (sweeps < until && finite) {
      Wave<T> wave;
      wave.sweeps = std::min(most_at_once, until - sweeps);
      wave.how = kind.how;
      Momentum expected = momentum;
      for (int s = 0; s < wave.sweeps; ++s)
        wave.betas[s] = s == 0 ? beta : static_cast<T>(expected.next_of_falling());
      take_wave(contacts, halo, wave, blocks);
      const auto of_sweeps = steps_of_wave(wave.sweeps);
      for (int s = 0; s < wave.sweeps; ++s) {
        steps = of_sweeps[s];
        finite = finite && std::isfinite(steps);
        beta = static_cast<T>(momentum.next(steps));
      }
      sweeps += wave.sweeps;
    }
    const bool last = sweeps >= rule.max_sweeps || !finite;
    if (!end.estimate_due(steps, last))
      end.leave_out();
    else if (end.ends(swept, sweeps, steps, finite, last))
      return end.report();
  }
}

template <class Problem>
SolveReport TileSolver<Problem>::solve(const Problem& problem, const TiledContacts& contacts, Halo& halo,
                                       const StoppingRule& rule, TileMethod method,
                                       Solution<Problem>& solution) {
  constexpr double single_precision_reaches = 1e-4;
  solution.impulses.resize(problem.q.size());
  estimates_.assign(contacts.tiles.size(), {});
  std::array<std::int64_t, 2> count{problem.contacts(), is_steep(problem)};
  ranks_.add(count);
  if (count[0] == 0) {
    StoppingTest test(rule);
    (void)test.ends(0, residual(problem, contacts, halo, solution));
    return test.report();
  }
  steep_ = count[1] > 0;
  const auto in_double = [&](const StoppingRule& own, bool accelerated) {
    return sweep_until_done(problem, contacts, halo, own, count[0], in_double_, accelerated, solution);
  };
  const auto plainly = [&](const StoppingRule& whole) {
    const auto sweep = [&](const StoppingRule& own) { return in_double(own, false); };
    if (!steep_) return sweep(whole);
    return from_two_starts(whole, solution.impulses, sweep,
                           [&] { return residual(problem, contacts, halo, solution); });
  };
  if (method == TileMethod::nlgs) return plainly(rule);
  const bool twice_in_double = method == TileMethod::accelerated_double;
  if (twice_in_double && !steep_) return in_double(rule, true);
  StoppingRule coarse = rule;
  if (!twice_in_double) coarse.tolerance = std::max(rule.tolerance, single_precision_reaches);
  const SolveReport first = twice_in_double ? in_double(rule, true)
                                            : sweep_until_done(problem, contacts, halo, coarse, count[0],
                                                               in_single_, true, solution);
  const bool done = first.status == Status::converged && rule.tolerance == coarse.tolerance;
  if (done) return first;
  return go_on(
      rule, first, solution.impulses,
      [&](const StoppingRule& left) {
        in_single_ = {};  // few solves need both: none holds both
        const SolveReport second = steep_ ? plainly(left) : in_double(left, true);
        in_double_ = {};
        return second;
      },
      [&] { return residual(problem, contacts, halo, solution); });
}

template class TileSolver<FrictionlessProblem>;
template class TileSolver<CoulombProblem>;
template class TileSolver<CoulombSpinProblem>;

}  // namespace drumlin::particles
