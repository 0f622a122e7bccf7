#include "particles/solver/strip_solver.hpp"

#include <algorithm>
#include <numeric>

#include "particles/contact/problems.hpp"

namespace drumlin::particles {

template <class T, int dim, bool spin>
template <class Problem>
void StripProblem<T, dim, spin>::pack(const Problem& problem, const SweepPlan& plan,
                                      std::span<const std::int32_t> order, std::span<const double> r) {
  constexpr int width = ContactBlock<T, dim>::width;
  const auto& W = problem.W;
  const int strip_count = plan.strips();
  const auto bodies = static_cast<std::int32_t>(plan.body_order.size());
  strips_.assign(strip_count, Strip{});
  for (auto& squares : step_squares_) squares.assign(2 * static_cast<std::size_t>(strip_count), 0.0);
  residual_squares_.assign(strip_count, 0.0);
  place_.resize(bodies);
  bodies_.clear();
  for (int k = 0; k < strip_count; ++k) {
    strips_[k].bodies = bodies_.size();
    for (std::int32_t o = plan.strip_bodies[k]; o < plan.strip_bodies[k + 1]; ++o) {
      const std::int32_t b = plan.body_order[o];
      place_[b] = static_cast<std::int32_t>(bodies_.size());
      bodies_.push_back({0, 0, 0, static_cast<T>(W.inverse_mass[b])});
    }
    // Records go in pairs (a vector of eight floats).
    if (bodies_.size() % 2 != 0) bodies_.push_back({});
    // The fixed body of walls, once for each place of a vector: contacts of a vector share no body.
    bodies_.insert(bodies_.end(), width, BodyRecord<T>{});
    strips_[k].bodies_end = bodies_.size();
  }
  before_.resize(bodies_.size());

  blocks_.clear();
  contact_.clear();
  for (int slice = 0; slice < 2 * strip_count; ++slice) {
    Strip& strip = strips_[slice / 2];
    strip.block[slice % 2] = blocks_.size();
    const auto fixed = static_cast<std::int32_t>(strip.bodies_end) - width;
    for (std::int32_t g = plan.slice_start[slice]; g < plan.slice_start[slice + 1]; ++g)
      for (std::int32_t a = plan.group_start[g]; a < plan.group_start[g + 1]; a += width) {
        auto& block = blocks_.emplace_back();
        const std::int32_t end = std::min(a + width, plan.group_start[g + 1]);
        for (int k = 0; k < width; ++k) {
          const std::int32_t c = a + k >= end ? -1 : order.empty() ? a + k : order[a + k];
          contact_.push_back(c);
          block.i[k] = c >= 0 ? place_[W.i[c]] : fixed + k;
          block.j[k] = c >= 0 && W.j[c] < bodies ? place_[W.j[c]] : fixed + k;
          block.n_x[k] = c >= 0 ? static_cast<T>(W.n_x[c]) : T(0);
          block.n_z[k] = c >= 0 ? static_cast<T>(W.n_z[c]) : T(0);
          block.inverse_W_nn[k] = c >= 0 ? static_cast<T>(W.inverse_W_nn[c]) : T(1);
          for (int e = 0; e < dim; ++e) {
            block.q[e][k] = c >= 0 ? static_cast<T>(problem.q[dim * c + e]) : T(0);
            block.r[e][k] = c >= 0 ? static_cast<T>(r[dim * c + e]) : T(0);
            block.before[e][k] = block.r[e][k];
          }
          if constexpr (dim == 2) block.mu[k] = c >= 0 ? static_cast<T>(problem.mu[c]) : T(0);
        }
      }
    strip.block[slice % 2 + 1] = blocks_.size();
  }
}

template <class T, int dim, bool spin>
template <class Problem>
void StripProblem<T, dim, spin>::unpack(const Problem& problem, std::vector<double>& r) const {
  constexpr int width = ContactBlock<T, dim>::width;
  for (std::size_t p = 0; p < contact_.size(); ++p) {
    const std::int32_t c = contact_[p];
    if (c < 0) continue;
    const auto& block = blocks_[p / width];
    r[dim * c] = static_cast<double>(block.r[0][p % width]);
    if constexpr (dim == 2) {
      const double bound = problem.mu[c] * r[2 * c];
      r[2 * c + 1] = std::clamp(static_cast<double>(block.r[1][p % width]), -bound, bound);
    }
  }
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
void StripProblem<T, dim, spin>::sweep(int strip, int phase, int parity, T beta, bool accelerated) {
  const Strip& l = strips_[strip];
  if (accelerated && phase == 0)
    Kernels::go_on(&bodies_[l.bodies], &before_[l.bodies], l.bodies_end - l.bodies, beta);
  step_squares_[parity][2 * strip + phase] =
      Kernels::sweep(blocks_.data() + l.block[phase], l.block[phase + 1] - l.block[phase], bodies_.data(),
                     beta, accelerated);
}

template <class T, int dim, bool spin>
double StripProblem<T, dim, spin>::step_squares(int parity) const {
  return std::accumulate(step_squares_[parity].begin(), step_squares_[parity].end(), 0.0);
}

template <class T, int dim, bool spin>
void StripProblem<T, dim, spin>::look_at(int strip) {
  const Strip& l = strips_[strip];
  residual_squares_[strip] =
      Kernels::residual(blocks_.data() + l.block[0], l.block[2] - l.block[0], bodies_.data());
}

template <class T, int dim, bool spin>
double StripProblem<T, dim, spin>::residual_squares() const {
  return std::accumulate(residual_squares_.begin(), residual_squares_.end(), 0.0);
}

#define DRUMLIN_INSTANTIATE(T, dim, spin, Problem)                                                        \
  template class StripProblem<T, dim, spin>;                                                              \
  template void StripProblem<T, dim, spin>::pack(const Problem&, const SweepPlan&,                        \
                                                 std::span<const std::int32_t>, std::span<const double>); \
  template void StripProblem<T, dim, spin>::unpack(const Problem&, std::vector<double>&) const;
DRUMLIN_INSTANTIATE(double, 1, false, FrictionlessProblem)
DRUMLIN_INSTANTIATE(double, 2, false, CoulombProblem)
DRUMLIN_INSTANTIATE(double, 2, true, CoulombSpinProblem)
DRUMLIN_INSTANTIATE(float, 1, false, FrictionlessProblem)
DRUMLIN_INSTANTIATE(float, 2, false, CoulombProblem)
DRUMLIN_INSTANTIATE(float, 2, true, CoulombSpinProblem)
#undef DRUMLIN_INSTANTIATE

}  // namespace drumlin::particles
