#include "particles/lab/proximal_newton.hpp"

#include <algorithm>
#include <cmath>

#include "particles/lab/diagonal_entry.hpp"

namespace drumlin::particles {
namespace {

constexpr int newton_steps = 40;  // without success by then, kappa was too large

double dot(std::span<const double> x, std::span<const double> y) {
  double sum = 0;
  for (std::size_t k = 0; k < x.size(); ++k) sum += x[k] * y[k];
  return sum;
}

}  // namespace

template <class Problem>
ProximalNewton<Problem>::ProximalNewton(const Problem& problem)
    : problem_(problem), system_(problem.W), zero_(problem.q.size(), 0.0), answers_(problem.contacts()) {}

template <class Problem>
std::optional<std::vector<double>> ProximalNewton<Problem>::step(const std::vector<double>& centre,
                                                                 double kappa,
                                                                 const MayFactorise& may_factorise) {
  centre_ = &centre;
  kappa_ = kappa;
  std::vector<double> r = centre;
  double fault = evaluate(r);
  // Of the velocities; rounding errors of u come back kappa times.
  const double rounding = 1e-14 * kappa * std::sqrt(std::max(0.0, dot(r, u_) - dot(r, problem_.q)));
  for (factorisations_ = 0; factorisations_ < newton_steps && may_factorise();) {
    ++factorisations_;
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

/// Answer of each contact to the velocities of r, and how far r is from it, in the norm of kinetic energy.
template <class Problem>
double ProximalNewton<Problem>::evaluate(const std::vector<double>& r) {
  problem_.W.velocities(r, problem_.q, state_, u_);
  answer_.resize(r.size());
  for (int a = 0; a < problem_.contacts(); ++a) answer(a);
  difference_.resize(r.size());
  for (std::size_t k = 0; k < r.size(); ++k) difference_[k] = r[k] - answer_[k];
  problem_.W.velocities(difference_, zero_, state_, image_);
  return std::sqrt(std::max(0.0, dot(difference_, image_)));
}

template <class Problem>
void ProximalNewton<Problem>::answer(int a) {
  ContactResponse& D = answers_[a];
  const double k_n = kappa_ / diagonal_entry(problem_.W, a, 0);
  const double r_n = (*centre_)[dim * a] - k_n * u_[dim * a];
  D.nn = r_n > 0 ? k_n : 0;
  answer_[dim * a] = std::max(0.0, r_n);
  if constexpr (dim == 2) {
    const double k_t = kappa_ / diagonal_entry(problem_.W, a, 1);
    const double r_t = (*centre_)[2 * a + 1] - k_t * u_[2 * a + 1];
    const bool sticks = std::abs(r_t) < problem_.mu[a] * answer_[2 * a];
    D.tt = sticks ? k_t : 0;
    D.tn = sticks ? 0 : std::copysign(problem_.mu[a] * D.nn, r_t);
    answer_[2 * a + 1] = contact_law::bounded(Coulomb{}, {problem_.mu[a]}, std::array{r_n, r_t})[1];
  }
}

/// r - t change with the first t of 1, 1/2, 1/4... that makes r less wrong; returns t, 0 if none does.
template <class Problem>
double ProximalNewton<Problem>::search(std::vector<double>& r, const std::vector<double>& change,
                                       double& fault) {
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

template class ProximalNewton<FrictionlessProblem>;
template class ProximalNewton<CoulombProblem>;
template class ProximalNewton<CoulombSpinProblem>;
template class ProximalNewton<BlockProblem>;

}  // namespace drumlin::particles
