// Conjugate projected gradients (declared in any_solver.hpp).
#include <algorithm>
#include <cmath>

#include "particles/lab/any_solver.hpp"
#include "particles/lab/diagonal_entry.hpp"
#include "particles/parallel/parallel_loops.hpp"

namespace drumlin::particles {
namespace {

// The bounds of friction move on when what is left of the quadratic problem is smaller than this share of
// what moving them would change: smaller shares solve problems exactly that are then replaced, larger ones
// lose conjugacy for nothing. Counted in products on captured drums: 0.1, 0.3 and 0.5 differ little, 1 loses.
constexpr double share_left = 0.5;

// Products after which u is computed anew, against the rounding errors of its updates.
constexpr int refresh_every = 50;

double dot(ParallelLoops& loops, std::span<const double> x, std::span<const double> y) {
  return loops.sum(x.size(), [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t k = begin; k < end; ++k) sum += x[k] * y[k];
    return sum;
  });
}

/// u = W r + q, of discs on all threads.
template <class Problem>
void multiply(const Problem& problem, const ParallelLoops& loops, std::span<const double> r,
              std::span<const double> q, typename Problem::Delassus::State& state, std::vector<double>& u) {
  const auto& W = problem.W;
  if constexpr (of_discs<Problem>) {
    W.load(state, r, loops);
    u.resize(q.size());
    loops.each(static_cast<std::size_t>(W.contacts()), [&](std::size_t begin, std::size_t end) {
      W.velocities_of(static_cast<int>(begin), static_cast<int>(end), q, state, u);
    });
  } else {
    W.velocities(r, q, state, u);
  }
}

struct ProjectedGradientWorkspace {
  std::vector<double> zero, preconditioner;
  std::vector<double> bound;             // of the friction of each contact, as it stands
  std::vector<double> u;                 // W r + q
  std::vector<double> gradient;          // preconditioned, downhill, projected on the tangent cone
  std::vector<double> direction, image;  // p and W p
  std::vector<double> r_before, u_before;
  std::vector<double> in_cone;  // r with its friction held to Coulomb's cone: what is returned
};

/// min 1/2 r W r + q r over r_n >= 0, |r_t| <= bound, one step at a time; and the bounds, which follow mu
/// r_n.
template <class Problem>
class ProjectedGradient {
  static constexpr int dim = Problem::dim;

 public:
  ProjectedGradient(const Problem& problem, ThreadPool* pool, std::vector<double>& r)
      : problem_(problem), r_(r), loops_(problem.contacts() > 2000 ? pool : nullptr) {
    const auto size = problem.q.size();
    r_.resize(size);
    work_.zero.assign(size, 0.0);
    work_.preconditioner.resize(size);
    work_.gradient.resize(size);
    work_.direction.resize(size);
    for (int a = 0; a < problem.contacts(); ++a)
      for (int c = 0; c < dim; ++c) work_.preconditioner[dim * a + c] = 1 / diagonal_entry(problem.W, a, c);
    for (int a = 0; a < problem.contacts(); ++a) r_[dim * a] = std::max(0.0, r_[dim * a]);
    move_bounds();
  }

  /// One product with W: a step of the quadratic problem, or a move of its bounds.
  void advance() {
    const double left = project_gradient();
    if (dim == 2 && left <= share_left * share_left * change_of_bounds())
      move_bounds();
    else
      step();
  }

  const std::vector<double>& impulses_in_cone() {
    work_.in_cone = r_;
    if constexpr (dim == 2)
      for (int a = 0; a < problem_.contacts(); ++a)
        work_.in_cone[2 * a + 1] =
            contact_law::bounded(Coulomb{}, {problem_.mu[a]}, std::array{r_[2 * a], r_[2 * a + 1]})[1];
    return work_.in_cone;
  }

 private:
  void move_bounds() {
    if constexpr (dim == 2) {
      work_.bound.resize(problem_.contacts());
      for (int a = 0; a < problem_.contacts(); ++a) work_.bound[a] = problem_.mu[a] * r_[2 * a];
    }
    project(r_);
    multiply(problem_, loops_, r_, problem_.q, state_, work_.u);
    restart_ = true;
  }

  void project(std::vector<double>& x) const {
    loops_.each(static_cast<std::size_t>(problem_.contacts()), [&](std::size_t begin, std::size_t end) {
      for (std::size_t a = begin; a < end; ++a) {
        x[dim * a] = std::max(0.0, x[dim * a]);
        if constexpr (dim == 2) x[2 * a + 1] = std::clamp(x[2 * a + 1], -work_.bound[a], work_.bound[a]);
      }
    });
  }

  /// The part of a change of contact a that does not leave the bounds.
  double tangent(std::size_t a, int c, double change) const {
    const double at = r_[dim * a + c];
    const bool stopped = c == 0
                             ? at <= 0 && change < 0
                             : (change > 0 && at >= work_.bound[a]) || (change < 0 && at <= -work_.bound[a]);
    return stopped ? 0 : change;
  }

  /// Returns the squared norm of the gradient, in the norm of the diagonal of W^-1.
  double project_gradient() {
    return loops_.sum(static_cast<std::size_t>(problem_.contacts()), [&](std::size_t begin, std::size_t end) {
      double squares = 0;
      for (std::size_t a = begin; a < end; ++a)
        for (int c = 0; c < dim; ++c) {
          const std::size_t k = dim * a + c;
          work_.gradient[k] = tangent(a, c, -work_.preconditioner[k] * work_.u[k]);
          squares += work_.gradient[k] * work_.gradient[k] / work_.preconditioner[k];
        }
      return squares;
    });
  }

  /// Squared norm, in the same sense, of what the friction would change if the bounds moved and every contact
  /// at its bound went along.
  double change_of_bounds() {
    return loops_.sum(static_cast<std::size_t>(problem_.contacts()), [&](std::size_t begin, std::size_t end) {
      double squares = 0;
      for (std::size_t a = begin; a < end; ++a) {
        const double now = r_[dim * a + 1], fresh = problem_.mu[a] * r_[dim * a];
        const double moved =
            std::abs(now) >= work_.bound[a] ? std::copysign(fresh, now) : std::clamp(now, -fresh, fresh);
        squares += (moved - now) * (moved - now) / work_.preconditioner[dim * a + 1];
      }
      return squares;
    });
  }

  /// Along the gradient at first, then conjugate to the last direction, of which only the part within the
  /// tangent cone is kept (Renouf and Alart: the projected direction z).
  void choose_direction() {
    auto& p = work_.direction;
    const double curvature = restart_ ? 0 : dot(loops_, p, work_.image);
    if (curvature > 0) {
      const double beta = -dot(loops_, work_.gradient, work_.image) / curvature;
      loops_.each(static_cast<std::size_t>(problem_.contacts()), [&](std::size_t begin, std::size_t end) {
        for (std::size_t a = begin; a < end; ++a)
          for (int c = 0; c < dim; ++c) {
            const std::size_t k = dim * a + c;
            p[k] = work_.gradient[k] + beta * tangent(a, c, p[k]);
          }
      });
    }
    if (curvature <= 0 || dot(loops_, work_.u, p) >= 0) p = work_.gradient;
    restart_ = false;
  }

  double energy() { return (dot(loops_, r_, work_.u) + dot(loops_, r_, problem_.q)) / 2; }

  void step() {
    choose_direction();
    multiply(problem_, loops_, work_.direction, work_.zero, state_, work_.image);
    const double curvature = dot(loops_, work_.direction, work_.image);
    if (curvature <= 0) {  // at the minimum, the gradient is zero
      restart_ = true;
      return;
    }
    const double length = -dot(loops_, work_.u, work_.direction) / curvature;
    const double energy_before = energy();
    work_.r_before = r_;
    work_.u_before = work_.u;
    go_along(length);
    work_.in_cone = r_;
    project(r_);
    const bool bounded = r_ != work_.in_cone;
    if (bounded || ++steps_since_refresh_ >= refresh_every) refresh();
    // Only the projection can go uphill, and does so once in thousands of steps: then stop at the first
    // bound.
    if (bounded && energy() > energy_before + 1e-14 * std::abs(energy_before)) {
      r_ = work_.r_before;
      work_.u = work_.u_before;
      go_along(length_to_first_bound(length));
      project(r_);
      restart_ = true;
    }
  }

  void go_along(double length) {
    loops_.each(r_.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        r_[k] += length * work_.direction[k];
        work_.u[k] += length * work_.image[k];
      }
    });
  }

  void refresh() {
    multiply(problem_, loops_, r_, problem_.q, state_, work_.u);
    steps_since_refresh_ = 0;
  }

  double length_to_first_bound(double length) const {
    for (int a = 0; a < problem_.contacts(); ++a) {
      const double n = work_.direction[dim * a];
      if (n < 0) length = std::min(length, -r_[dim * a] / n);
      if constexpr (dim == 2) {
        const double t = work_.direction[2 * a + 1];
        const double room = work_.bound[a] - (t > 0 ? r_[2 * a + 1] : -r_[2 * a + 1]);
        if (t != 0) length = std::min(length, room / std::abs(t));
      }
    }
    return length;
  }

  const Problem& problem_;
  typename Problem::Delassus::State state_;
  ProjectedGradientWorkspace work_;
  std::vector<double>& r_;
  ParallelLoops loops_;
  bool restart_ = true;
  int steps_since_refresh_ = 0;
};

}  // namespace

template <class Problem>
SolveReport solve_cpg(const Problem& problem, const StoppingRule& rule, SolverWorkspace<Problem>& work,
                      Solution<Problem>& solution) {
  StoppingTest test(rule);
  ProjectedGradient<Problem> gradient(problem, work.pool, solution.impulses);
  for (int sweeps = 1;; ++sweeps) {
    gradient.advance();
    if (!test.due(sweeps)) continue;
    const std::vector<double>& found = gradient.impulses_in_cone();
    if (!test.ends(sweeps, residual_of(problem, std::span<const double>(found), solution.velocities)))
      continue;
    solution.impulses = found;
    return test.report();
  }
}

#define DRUMLIN_INSTANTIATE(Problem, ...)                                                        \
  template SolveReport solve_cpg(const Problem&, const StoppingRule&, SolverWorkspace<Problem>&, \
                                 Solution<Problem>&);
DRUMLIN_EACH_PLAIN_PROBLEM(DRUMLIN_INSTANTIATE)
DRUMLIN_INSTANTIATE(BlockProblem)
#undef DRUMLIN_INSTANTIATE

}  // namespace drumlin::particles
