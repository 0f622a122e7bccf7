#include "particles/solver/strip_solver.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "particles/contact/problems.hpp"
#include "particles/solver/contact_blocks.hpp"

namespace drumlin::particles {

template <class T, class Law, bool spin>
template <class Problem>
void StripProblem<T, Law, spin>::pack_bodies(const Problem& problem, const SweepPlan& plan) {
  const auto& W = problem.W;
  driven_bodies_ = 0;
  for (int k = 0; k < plan.strips(); ++k) {
    strips_[k].bodies = driven_bodies_;
    const std::size_t own = plan.strip_bodies[k + 1] - plan.strip_bodies[k];
    // Records go in pairs (a vector of eight floats). The fixed body of walls stands once for each position
    // of a vector: contacts of a vector share no body.
    strips_[k].bodies_end = driven_bodies_ += own + own % 2 + Block::width;
  }
  const std::size_t all = driven_bodies_ + W.driven.size() + W.driven.size() % 2 + 2 * W.cell.has_value();
  require_offsets<T>(all);
  place_.resize_uninitialized(plan.body_order.size());
  bodies_.resize_uninitialized(all);
  before_.resize_uninitialized(all);
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

template <class T, class Law, bool spin>
template <class Problem>
void StripProblem<T, Law, spin>::pack_place(const Problem& problem, std::int32_t c, std::int32_t fixed,
                                            std::span<const double> r, std::size_t place) {
  const auto& W = problem.W;
  const auto k = static_cast<std::int32_t>(place % Block::width);
  contact_[place] = c;
  const std::int32_t i = c >= 0 ? place_[W.i[c]] : fixed + k;
  const std::int32_t j = c >= 0 && W.j[c] < W.fixed() ? place_[W.j[c]] : fixed + k;
  set_place(problem, c, i, j, r, blocks_[place / Block::width], k);
}

template <class T, class Law, bool spin>
template <class Problem>
void StripProblem<T, Law, spin>::pack_driven(const Problem& problem, std::int32_t c,
                                             std::span<const double> r) {
  const auto& W = problem.W;
  auto& contact = driven_.emplace_back();
  contact.contact = c;
  contact.i = place_[W.i[c]];
  contact.rates = static_cast<std::int32_t>(driven_bodies_);
  contact.j = W.cell ? place_[W.j[c]] : contact.rates + W.j[c] - W.fixed() - 1;
  contact.W = W.block(c);
  contact.mu = problem.coefficients(c);
  for (int e = 0; e < dim; ++e) {
    contact.q[e] = problem.q[dim * c + e];
    contact.r[e] = contact.before[e] = r[dim * c + e];
  }
}

template <class T, class Law, bool spin>
template <class Problem>
void StripProblem<T, Law, spin>::lay_out(const Problem& problem, const SweepPlan& plan,
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
      if (problem.W.coupled())
        for (std::int32_t a = plan.group_start[g]; a < plan.group_start[g + 1]; ++a)
          if (const std::int32_t c = order.empty() ? a : order[a]; problem.W.pushes_more(c))
            pack_driven(problem, c, r), --count;
      const std::int32_t own = (count + width - 1) / width;
      groups_.push_back(own);
      blocks += own;
    }
    strip.block[slice % 2 + 1] = blocks;
    strip.group[slice % 2 + 1] = groups_.size();
  }
  blocks_.resize_uninitialized(blocks);
  contact_.resize_uninitialized(blocks * width);
  kept_.resize_uninitialized(blocks);
}

template <class T, class Law, bool spin>
template <class Problem>
void StripProblem<T, Law, spin>::pack_strip(const Problem& problem, const SweepPlan& plan,
                                            std::span<const std::int32_t> order, std::span<const double> r,
                                            int strip) {
  constexpr int width = Block::width;
  const auto fixed = static_cast<std::int32_t>(strips_[strip].bodies_end) - width;
  std::size_t place = width * strips_[strip].block[0];
  const bool coupled = problem.W.coupled();
  const std::int32_t end = plan.slice_start[2 * strip + 2];
  for (std::int32_t g = plan.slice_start[2 * strip]; g < end; ++g) {
    for (std::int32_t a = plan.group_start[g]; a < plan.group_start[g + 1]; ++a) {
      const std::int32_t c = order.empty() ? a : order[a];
      if (!coupled || !problem.W.pushes_more(c)) pack_place(problem, c, fixed, r, place++);
    }
    while (place % width != 0) pack_place(problem, -1, fixed, r, place++);
  }
}

template <class T, class Law, bool spin>
template <class Problem>
void StripProblem<T, Law, spin>::pack(const Problem& problem, const SweepPlan& plan,
                                      std::span<const std::int32_t> order, std::span<const double> r,
                                      const ParallelLoops& loops, World* world) {
  const int strip_count = plan.strips();
  W_ = &problem.W;
  strips_.assign(strip_count, Strip{});
  for (auto& squares : step_squares_) squares.assign(2 * static_cast<std::size_t>(strip_count) + 1, 0.0);
  estimates_.assign(2 * static_cast<std::size_t>(strip_count), {});
  pack_bodies(problem, plan);
  lay_out(problem, plan, order, r);
  share(order.empty() && driven_.empty() ? world : nullptr);
  const auto [first, end] = own();
  const auto pack_one = [&, first = first](int k) { pack_strip(problem, plan, order, r, first + k); };
  (strip_count < 4 ? ParallelLoops() : loops).each_of(end - first, pack_one);
  if (world_ == nullptr) return;
  border_[0] = border_of(problem, plan, first);
  border_[1] = border_of(problem, plan, end);
  contacts_of_ranks_.clear();
  for (const int strip : strips_of_ranks_)
    contacts_of_ranks_.push_back(plan.group_start[plan.slice_start[2 * strip]] *
                                 static_cast<std::size_t>(dim));
}

template <class T, class Law, bool spin>
void StripProblem<T, Law, spin>::share(World* world) {
  constexpr int least_strips = 2;
  rank_ = world != nullptr ? world->rank() : 0;
  const auto have_some = [&] {
    for (int rank = 0; rank < ranks_; ++rank)
      if (first_of(first_part(rank + 1)) - first_of(first_part(rank)) < least_strips) return false;
    return true;
  };
  ranks_ = world != nullptr ? std::min(world->ranks(), parts) : 1;
  while (ranks_ > 1 && !have_some()) --ranks_;
  world_ = ranks_ > 1 ? world : nullptr;
  if (ranks_ == 1) rank_ = 0;
  strips_of_ranks_.clear();
  for (int rank = 0; rank <= (world_ != nullptr ? world_->ranks() : 1); ++rank)
    strips_of_ranks_.push_back(first_of(first_part(rank)));
}

template <class T, class Law, bool spin>
template <class Problem>
std::vector<std::int32_t> StripProblem<T, Law, spin>::border_of(const Problem& problem, const SweepPlan& plan,
                                                                int strip) const {
  std::vector<std::int32_t> border;
  if (strip == 0 || strip == strips()) return border;
  const auto& W = problem.W;
  const auto first = static_cast<std::int32_t>(strips_[strip].bodies);
  const std::int32_t slice = 2 * strip - 1;
  for (std::int32_t a = plan.group_start[plan.slice_start[slice]];
       a < plan.group_start[plan.slice_start[slice + 1]]; ++a)
    for (const std::int32_t b : {W.i[a], W.j[a]})
      if (b < W.fixed() && place_[b] >= first) border.push_back(place_[b]);
  std::sort(border.begin(), border.end());
  border.erase(std::unique(border.begin(), border.end()), border.end());
  return border;
}

template <class T, class Law, bool spin>
void StripProblem<T, Law, spin>::exchange(int phase, WorkArray<BodyRecord<T>>& records) {
  if (world_ == nullptr) return;
  const int before = rank_ < ranks_ ? rank_ - 1 : -1, after = rank_ + 1 < ranks_ ? rank_ + 1 : -1;
  const auto &out = border_[phase], &in = border_[1 - phase];
  sent_.resize(out.size()), received_.resize(in.size());
  for (std::size_t k = 0; k < out.size(); ++k) sent_[k] = records[out[k]];
  world_->pass(std::span<const BodyRecord<T>>(sent_), phase == 0 ? before : after, std::span(received_),
               phase == 0 ? after : before);
  for (std::size_t k = 0; k < in.size(); ++k) records[in[k]] = received_[k];
}

template <class T, class Law, bool spin>
template <class Entry>
void StripProblem<T, Law, spin>::gather(std::span<Entry> all, std::size_t of_strip) const {
  if (world_ == nullptr) return;
  std::vector<std::size_t> first;
  for (const int strip : strips_of_ranks_) first.push_back(of_strip * strip);
  world_->gather(all, first);
}

template <class T, class Law, bool spin>
void StripProblem<T, Law, spin>::gather_steps(int slot) {
  gather(std::span(step_squares_[slot]), 2);
}

template <class T, class Law, bool spin>
void StripProblem<T, Law, spin>::gather_estimates() {
  gather(std::span(estimates_), 2);
}

template <class T, class Law, bool spin>
void StripProblem<T, Law, spin>::gather_parts(std::span<double> all, std::size_t of_part) const {
  if (world_ == nullptr) return;
  std::vector<std::size_t> first;
  for (int rank = 0; rank <= world_->ranks(); ++rank) first.push_back(of_part * first_part(rank));
  world_->gather(all, first);
}

template <class T, class Law, bool spin>
template <class Problem>
void StripProblem<T, Law, spin>::unpack(const Problem& problem, bool kept, std::vector<double>& r,
                                        const ParallelLoops& loops) const {
  constexpr std::size_t width = Block::width;
  const auto [first_strip, end_strip] = own();
  loops.each_of(end_strip - first_strip, [&, first_strip = first_strip](int k) {
    const Strip& strip = strips_[first_strip + k];
    for (std::size_t p = width * strip.block[0]; p < width * strip.block[2]; ++p) {
      if (contact_[p] < 0) continue;
      const Impulses& block = kept ? kept_[p / width] : blocks_[p / width].r;
      hold_to_cone(problem, contact_[p], impulses_at(block, p % width), r);
    }
  });
  for (const auto& contact : driven_)
    hold_to_cone(problem, contact.contact, kept ? contact.kept : contact.r, r);
  if (world_ != nullptr) world_->gather(std::span(r), contacts_of_ranks_);
}

template <class T, class Law, bool spin>
void StripProblem<T, Law, spin>::rest(const ParallelLoops& loops) {
  loops.each(bodies_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) bodies_[b].x = bodies_[b].z = bodies_[b].s = 0;
  });
}

template <class T, class Law, bool spin>
int StripProblem<T, Law, spin>::first_of(int part) const {
  if (part == parts) return strips();
  return strip_at(blocks_.size() * part / parts, 0, strips());
}

template <class T, class Law, bool spin>
int StripProblem<T, Law, spin>::first_strip(int rank, int thread, int threads) const {
  const int begin = strips_of_ranks_[rank], end = strips_of_ranks_[rank + 1];
  if (thread == threads || begin == end) return end;
  const std::size_t first = strips_[begin].block[0], blocks = strips_[end - 1].block[2] - first;
  return strip_at(first + blocks * thread / threads, begin, end);
}

/// The strip of [begin, end) that holds a block in its second half, or the next one.
template <class T, class Law, bool spin>
int StripProblem<T, Law, spin>::strip_at(std::size_t block, int begin, int end) const {
  int strip = begin;
  while (strip < end && (strips_[strip].block[0] + strips_[strip].block[2]) / 2 < block) ++strip;
  return strip;
}

template <class T, class Law, bool spin>
void StripProblem<T, Law, spin>::load(int strip, int phase) {
  const Strip& l = strips_[strip];
  Kernels::load(blocks_.data() + l.block[phase], l.block[phase + 1] - l.block[phase], bodies_.data());
}

template <class T, class Law, bool spin>
void StripProblem<T, Law, spin>::start(int strip) {
  const Strip& l = strips_[strip];
  for (std::size_t b = l.bodies; b < l.bodies_end; ++b) before_[b] = bodies_[b];
}

template <class T, class Law, bool spin>
void StripProblem<T, Law, spin>::sweep(int strip, int phase, int slot, T beta, SweepExtrapolation how) {
  const Strip& l = strips_[strip];
  if (how != SweepExtrapolation::none && phase == 0)
    Kernels::go_on(&bodies_[l.bodies], &before_[l.bodies], l.bodies_end - l.bodies, beta);
  step_squares_[slot][2 * strip + phase] =
      Kernels::sweep(blocks_.data() + l.block[phase],
                     std::span(groups_).subspan(l.group[phase], l.group[phase + 1] - l.group[phase]),
                     bodies_.data(), beta, how);
}

template <class T, class Law, bool spin>
double StripProblem<T, Law, spin>::step_squares(int slot) const {
  return std::accumulate(step_squares_[slot].begin(), step_squares_[slot].end(), 0.0);
}

template <class T, class Law, bool spin>
void StripProblem<T, Law, spin>::load_driven() {
  drumlin::particles::load(*W_, std::span<const DrivenContact<Law>>(driven_), bodies_.data());
}

template <class T, class Law, bool spin>
void StripProblem<T, Law, spin>::start_driven() {
  for (std::size_t b = driven_bodies_; b < bodies_.size(); ++b) before_[b] = bodies_[b];
}

template <class T, class Law, bool spin>
void StripProblem<T, Law, spin>::sweep_driven(int slot, T beta, bool accelerated) {
  // Nobody else reads the walls: they go on when their contacts come.
  if (accelerated)
    Kernels::go_on(&bodies_[driven_bodies_], &before_[driven_bodies_], bodies_.size() - driven_bodies_, beta);
  step_squares_[slot].back() =
      drumlin::particles::sweep(*W_, std::span(driven_), bodies_.data(), beta, accelerated);
}

template <class T, class Law, bool spin>
void StripProblem<T, Law, spin>::estimate_residual(int strip, int phase) {
  const Strip& l = strips_[strip];
  estimates_[2 * strip + phase] =
      Kernels::residual(blocks_.data() + l.block[phase], l.block[phase + 1] - l.block[phase], bodies_.data());
}

template <class T, class Law, bool spin>
ResidualEstimate StripProblem<T, Law, spin>::residual_estimate() const {
  ResidualEstimate all = residual(*W_, std::span<const DrivenContact<Law>>(driven_), bodies_.data());
  for (const ResidualEstimate& of_slice : estimates_) all.add(of_slice);
  return all;
}

template <class T, class Law, bool spin>
double StripProblem<T, Law, spin>::summed_impulses(const ParallelLoops& loops) {
  impulses_of_strips_.assign(strips(), 0.0);
  const auto [first, end] = own();
  loops.each_of(end - first, [&, first = first](int k) {
    const Strip& strip = strips_[first + k];
    for (std::size_t b = strip.bodies; b < strip.bodies_end; ++b)
      impulses_of_strips_[first + k] += impulse_of(bodies_[b]);
  });
  gather(std::span(impulses_of_strips_), 1);
  return std::accumulate(impulses_of_strips_.begin(), impulses_of_strips_.end(), 0.0);
}

template <class T, class Law, bool spin>
void StripProblem<T, Law, spin>::keep(int strip) {
  for (std::size_t b = strips_[strip].block[0]; b < strips_[strip].block[2]; ++b) kept_[b] = blocks_[b].r;
}

template <class T, class Law, bool spin>
void StripProblem<T, Law, spin>::keep_driven() {
  for (auto& contact : driven_) contact.kept = contact.r;
}

#define DRUMLIN_INSTANTIATE(T, Law, spin, Problem)                                                       \
  template class StripProblem<T, Law, spin>;                                                             \
  template void StripProblem<T, Law, spin>::pack(const Problem&, const SweepPlan&,                       \
                                                 std::span<const std::int32_t>, std::span<const double>, \
                                                 const ParallelLoops&, World*);                          \
  template void StripProblem<T, Law, spin>::unpack(const Problem&, bool, std::vector<double>&,           \
                                                   const ParallelLoops&) const;
#define DRUMLIN_INSTANTIATE_BOTH(Problem, Law, spin) \
  DRUMLIN_INSTANTIATE(double, Law, spin, Problem)    \
  DRUMLIN_INSTANTIATE(float, Law, spin, Problem)
DRUMLIN_EACH_DISC_PROBLEM(DRUMLIN_INSTANTIATE_BOTH)
#undef DRUMLIN_INSTANTIATE_BOTH
#undef DRUMLIN_INSTANTIATE

}  // namespace drumlin::particles
