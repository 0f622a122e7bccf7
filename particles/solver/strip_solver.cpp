#include "particles/solver/strip_solver.hpp"

#include <algorithm>
#include <numeric>
#include <type_traits>
#include <utility>

#include "particles/contact/problems.hpp"
#include "particles/solver/contact_blocks.hpp"

namespace drumlin::particles {

namespace {

/// A problem with walls that contacts push.
template <class W>
constexpr bool drives = requires(const W& w) {
  w.driven_wall(0);
};

template <class W>
bool is_driven(const W& w, std::int32_t c) {
  if constexpr (drives<W>)
    return w.pushes_more(c);
  else
    return false;
}

}  // namespace

template <class T, int dim, bool spin>
template <class Problem>
void StripProblem<T, dim, spin>::pack_bodies(const Problem& problem, const SweepPlan& plan) {
  const auto& W = problem.W;
  driven_bodies_ = 0;
  for (int k = 0; k < plan.strips(); ++k) {
    strips_[k].bodies = driven_bodies_;
    const std::size_t own = plan.strip_bodies[k + 1] - plan.strip_bodies[k];
    // Records go in pairs (a vector of eight floats). The fixed body of walls stands once for each place of a
    // vector: contacts of a vector share no body.
    strips_[k].bodies_end = driven_bodies_ += own + own % 2 + Block::width;
  }
  std::size_t all = driven_bodies_;
  if constexpr (drives<std::remove_cvref_t<decltype(W)>>)
    all += W.driven.size() + W.driven.size() % 2 + 2 * W.cell.has_value();
  require_offsets<T>(all);
  place_.renew(plan.body_order.size());
  bodies_.renew(all);
  before_.renew(all);
  for (int k = 0; k < plan.strips(); ++k) {
    std::size_t place = strips_[k].bodies;
    for (std::int32_t o = plan.strip_bodies[k]; o < plan.strip_bodies[k + 1]; ++o, ++place) {
      const std::int32_t b = plan.body_order[o];
      place_[b] = static_cast<std::int32_t>(place);
      bodies_[place] = {0, 0, 0, static_cast<T>(W.inverse_mass[b])};
    }
    std::fill(bodies_.begin() + place, bodies_.begin() + strips_[k].bodies_end, BodyRecord<T>{});
  }
  std::fill(bodies_.begin() + driven_bodies_, bodies_.end(), BodyRecord<T>{});
}

template <class T, int dim, bool spin>
template <class Problem>
void StripProblem<T, dim, spin>::pack_place(const Problem& problem, std::int32_t c, std::int32_t fixed,
                                            std::span<const double> r, std::size_t place) {
  const auto& W = problem.W;
  const auto k = static_cast<std::int32_t>(place % Block::width);
  contact_[place] = c;
  const std::int32_t i = c >= 0 ? place_[W.i[c]] : fixed + k;
  const std::int32_t j = c >= 0 && W.j[c] < W.fixed() ? place_[W.j[c]] : fixed + k;
  set_place(problem, c, i, j, r, blocks_[place / Block::width], k);
}

template <class T, int dim, bool spin>
template <class Problem>
void StripProblem<T, dim, spin>::pack_driven(const Problem& problem, std::int32_t c,
                                             std::span<const double> r) {
  const auto& W = problem.W;
  auto& contact = driven_.emplace_back();
  contact.contact = c;
  contact.i = place_[W.i[c]];
  if (const DrivenBody* wall = W.driven_wall(c)) {
    contact.driven = *wall;
    contact.j = static_cast<std::int32_t>(driven_bodies_) + W.j[c] - W.fixed() - 1;
  } else {
    contact.j = place_[W.j[c]];
    contact.cell = static_cast<std::int32_t>(driven_bodies_);
    contact.arm_x = W.arm_x[c], contact.answer_x = W.arm_x[c] * W.cell->inverse_inertia_x;
    contact.arm_z = W.arm_z[c], contact.answer_z = W.arm_z[c] * W.cell->inverse_inertia_z;
  }
  contact.n_x = W.n_x[c], contact.n_z = W.n_z[c];
  if constexpr (dim == 3) contact.lever = W.lever[c];
  contact.W = W.block(c);

  for (int e = 0; e < dim; ++e) {
    contact.q[e] = problem.q[dim * c + e];
    contact.r[e] = contact.before[e] = r[dim * c + e];
  }
  for (int e = 0; e + 1 < dim; ++e) contact.mu[e] = problem.mu[(dim - 1) * c + e];
}

template <class T, int dim, bool spin>
template <class Problem>
void StripProblem<T, dim, spin>::lay_out(const Problem& problem, const SweepPlan& plan,
                                         std::span<const std::int32_t> order, std::span<const double> r) {
  constexpr int width = Block::width;
  std::size_t blocks = 0;
  groups_.clear();
  driven_.clear();
  for (int slice = 0; slice < 2 * strips(); ++slice) {
    Strip& strip = strips_[slice / 2];
    strip.block[slice % 2] = blocks;
    strip.group[slice % 2] = groups_.size();
    for (std::int32_t g = plan.slice_start[slice]; g < plan.slice_start[slice + 1]; ++g) {
      std::int32_t count = plan.group_start[g + 1] - plan.group_start[g];
      if constexpr (drives<typename Problem::Delassus>)
        for (std::int32_t a = plan.group_start[g]; a < plan.group_start[g + 1]; ++a)
          if (const std::int32_t c = order.empty() ? a : order[a]; is_driven(problem.W, c))
            pack_driven(problem, c, r), --count;
      const std::int32_t own = (count + width - 1) / width;
      groups_.push_back(own);
      blocks += own;
    }
    strip.block[slice % 2 + 1] = blocks;
    strip.group[slice % 2 + 1] = groups_.size();
  }
  blocks_.renew(blocks);
  contact_.renew(blocks * width);
  kept_.renew(blocks);
}

template <class T, int dim, bool spin>
template <class Problem>
void StripProblem<T, dim, spin>::pack_strip(const Problem& problem, const SweepPlan& plan,
                                            std::span<const std::int32_t> order, std::span<const double> r,
                                            int strip) {
  constexpr int width = Block::width;
  const auto fixed = static_cast<std::int32_t>(strips_[strip].bodies_end) - width;
  std::size_t place = width * strips_[strip].block[0];
  const std::int32_t end = plan.slice_start[2 * strip + 2];
  for (std::int32_t g = plan.slice_start[2 * strip]; g < end; ++g) {
    for (std::int32_t a = plan.group_start[g]; a < plan.group_start[g + 1]; ++a) {
      const std::int32_t c = order.empty() ? a : order[a];
      if (!is_driven(problem.W, c)) pack_place(problem, c, fixed, r, place++);
    }
    while (place % width != 0) pack_place(problem, -1, fixed, r, place++);
  }
}

template <class T, int dim, bool spin>
template <class Problem>
void StripProblem<T, dim, spin>::pack(const Problem& problem, const SweepPlan& plan,
                                      std::span<const std::int32_t> order, std::span<const double> r,
                                      const TeamLoops& loops) {
  const int strip_count = plan.strips();
  strips_.assign(strip_count, Strip{});
  for (auto& squares : step_squares_) squares.assign(2 * static_cast<std::size_t>(strip_count) + 1, 0.0);
  estimates_.assign(2 * static_cast<std::size_t>(strip_count), {});
  pack_bodies(problem, plan);
  lay_out(problem, plan, order, r);
  const auto pack_one = [&](int strip) { pack_strip(problem, plan, order, r, strip); };
  (strip_count < 4 ? TeamLoops() : loops).each_of(strip_count, pack_one);
}

template <class T, int dim, bool spin>
template <class Problem>
void StripProblem<T, dim, spin>::unpack(const Problem& problem, bool kept, std::vector<double>& r,
                                        const TeamLoops& loops) const {
  constexpr int width = Block::width;
  loops.each(contact_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      if (contact_[p] < 0) continue;
      const Impulses& block = kept ? kept_[p / width] : blocks_[p / width].r;
      hold_to_cone(problem, contact_[p], impulses_at(block, p % width), r);
    }
  });
  for (const auto& contact : driven_)
    hold_to_cone(problem, contact.contact, kept ? contact.kept : contact.r, r);
}

template <class T, int dim, bool spin>
void StripProblem<T, dim, spin>::rest(const TeamLoops& loops) {
  loops.each(bodies_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) bodies_[b].x = bodies_[b].z = bodies_[b].s = 0;
  });
}

template <class T, int dim, bool spin>
int StripProblem<T, dim, spin>::first_strip(int thread, int threads) const {
  if (thread == threads) return strips();
  const std::size_t wanted = blocks_.size() * thread / threads;
  int strip = 0;
  // The strip that holds the wanted block in its first half belongs to the later thread.
  while (strip < strips() && (strips_[strip].block[0] + strips_[strip].block[2]) / 2 < wanted) ++strip;
  return strip;
}

template <class T, int dim, bool spin>
void StripProblem<T, dim, spin>::load(int strip, int phase) {
  const Strip& l = strips_[strip];
  Kernels::load(blocks_.data() + l.block[phase], l.block[phase + 1] - l.block[phase], bodies_.data());
}

template <class T, int dim, bool spin>
void StripProblem<T, dim, spin>::start(int strip) {
  const Strip& l = strips_[strip];
  for (std::size_t b = l.bodies; b < l.bodies_end; ++b) before_[b] = bodies_[b];
}

template <class T, int dim, bool spin>
void StripProblem<T, dim, spin>::sweep(int strip, int phase, int slot, T beta, SweepExtrapolation how) {
  const Strip& l = strips_[strip];
  if (how != SweepExtrapolation::none && phase == 0)
    Kernels::go_on(&bodies_[l.bodies], &before_[l.bodies], l.bodies_end - l.bodies, beta);
  step_squares_[slot][2 * strip + phase] =
      Kernels::sweep(blocks_.data() + l.block[phase],
                     std::span(groups_).subspan(l.group[phase], l.group[phase + 1] - l.group[phase]),
                     bodies_.data(), beta, how);
}

template <class T, int dim, bool spin>
double StripProblem<T, dim, spin>::step_squares(int slot) const {
  return std::accumulate(step_squares_[slot].begin(), step_squares_[slot].end(), 0.0);
}

template <class T, int dim, bool spin>
void StripProblem<T, dim, spin>::load_driven() {
  for (const auto& contact : driven_) push<spin>(contact, contact.r, bodies_.data());
}

template <class T, int dim, bool spin>
void StripProblem<T, dim, spin>::start_driven() {
  for (std::size_t b = driven_bodies_; b < bodies_.size(); ++b) before_[b] = bodies_[b];
}

template <class T, int dim, bool spin>
void StripProblem<T, dim, spin>::sweep_driven(int slot, T beta, bool accelerated) {
  // Nobody else reads the walls: they go on when their contacts come.
  if (accelerated)
    Kernels::go_on(&bodies_[driven_bodies_], &before_[driven_bodies_], bodies_.size() - driven_bodies_, beta);
  step_squares_[slot].back() =
      drumlin::particles::sweep<spin>(std::span(driven_), bodies_.data(), beta, accelerated);
}

template <class T, int dim, bool spin>
void StripProblem<T, dim, spin>::estimate_residual(int strip, int phase) {
  const Strip& l = strips_[strip];
  estimates_[2 * strip + phase] =
      Kernels::residual(blocks_.data() + l.block[phase], l.block[phase + 1] - l.block[phase], bodies_.data());
}

template <class T, int dim, bool spin>
ResidualEstimate StripProblem<T, dim, spin>::residual_estimate() const {
  ResidualEstimate all = residual<spin>(std::span<const DrivenContact<dim>>(driven_), bodies_.data());
  for (const ResidualEstimate& of_slice : estimates_) all.add(of_slice);
  return all;
}

template <class T, int dim, bool spin>
double StripProblem<T, dim, spin>::summed_impulses(TeamLoops& loops) const {
  return drumlin::particles::summed_impulses(std::span<const BodyRecord<T>>(bodies_.data(), bodies_.size()),
                                             loops);
}

template <class T, int dim, bool spin>
void StripProblem<T, dim, spin>::keep(int strip) {
  for (std::size_t b = strips_[strip].block[0]; b < strips_[strip].block[2]; ++b) kept_[b] = blocks_[b].r;
}

template <class T, int dim, bool spin>
void StripProblem<T, dim, spin>::keep_driven() {
  for (auto& contact : driven_) contact.kept = contact.r;
}

#define DRUMLIN_INSTANTIATE(T, dim, spin, Problem)                                                       \
  template void StripProblem<T, dim, spin>::pack(const Problem&, const SweepPlan&,                       \
                                                 std::span<const std::int32_t>, std::span<const double>, \
                                                 const TeamLoops&);                                      \
  template void StripProblem<T, dim, spin>::unpack(const Problem&, bool, std::vector<double>&,           \
                                                   const TeamLoops&) const;
#define DRUMLIN_INSTANTIATE_BOTH(dim, spin, Problem, DrivenProblem) \
  template class StripProblem<double, dim, spin>;                   \
  template class StripProblem<float, dim, spin>;                    \
  DRUMLIN_INSTANTIATE(double, dim, spin, Problem)                   \
  DRUMLIN_INSTANTIATE(double, dim, spin, DrivenProblem)             \
  DRUMLIN_INSTANTIATE(float, dim, spin, Problem)                    \
  DRUMLIN_INSTANTIATE(float, dim, spin, DrivenProblem)
DRUMLIN_INSTANTIATE_BOTH(1, false, FrictionlessProblem, DrivenFrictionlessProblem)
DRUMLIN_INSTANTIATE_BOTH(2, false, CoulombProblem, DrivenCoulombProblem)
DRUMLIN_INSTANTIATE_BOTH(2, true, CoulombSpinProblem, DrivenCoulombSpinProblem)
DRUMLIN_INSTANTIATE_BOTH(3, true, CoulombRollingProblem, DrivenRollingProblem)
#undef DRUMLIN_INSTANTIATE_BOTH
#undef DRUMLIN_INSTANTIATE

}  // namespace drumlin::particles
