#include "particles/solver/pivoting.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "particles/contact/problems.hpp"

namespace drumlin::particles {
namespace {

constexpr double compliance = 1e-6;  // of W_aa

/// The path of solutions: a basis of two rays a contact, but for one of which z has taken a position.
class PivotPath {
 public:
  PivotPath(Eigen::MatrixXd W, Eigen::VectorXd q, std::span<const double> mu)
      : W_(std::move(W)), unit_(q.size()), x_(std::move(q)), mu_(mu), inverse_(W_.rows(), W_.cols()) {
    // Velocities in units that make the diagonal of W about 1.
    for (int k = 0; k < size(); ++k) unit_[k] = 1 / std::sqrt(W_(k - k % 2, k - k % 2));
    W_ = unit_.asDiagonal() * W_ * unit_.asDiagonal();
    W_.diagonal() *= 1 + compliance;
    x_ = x_.cwiseProduct(unit_).eval();
    open_all();
  }

  std::optional<Eigen::VectorXd> impulses_at_end(int most_pivots) {
    Eigen::VectorXd rates = Eigen::VectorXd::Zero(size());
    int place = 0;  // of the contact that closes first
    for (int k = 0; k < size(); k += 2) {
      rates[k] = -opening(k / 2);
      if (x_[k] / rates[k] > x_[place] / rates[place]) place = k;
    }
    if (x_[place] >= 0) return impulses();
    for (int left = enter(z, place, rates), pivots = 0; left != z; ++pivots) {
      if (pivots == most_pivots) return {};
      const int entering = next_of(left);
      rates = inverse_ * column(entering);
      place = first_to_leave(rates);
      if (place < 0) return {};  // rounding alone
      left = enter(entering, place, rates);
    }
    return impulses();
  }

 private:
  // Variables: rays * contact + ray. A ray's neighbours are the one before and the one after it, in a circle.
  enum Ray { forward, slides_back, parts, slides_on, backward, rays };
  static constexpr int z = -1;

  int size() const { return static_cast<int>(unit_.size()); }
  /// Without a pattern, so that no two contacts lose their rays at once.
  static double opening(int a) { return 1 + std::fmod(0.6180339887498949 * (a + 1), 1.0); }

  void open_all() {
    inverse_.setZero();
    for (int k = 0; k < size(); ++k) {
      const bool back = k % 2 == 1 && x_[k] < 0;
      variables_.push_back(rays * (k / 2) + (k % 2 == 0 ? parts : back ? slides_back : slides_on));
      inverse_(k, k) = back ? 1 : -1;
      if (back) x_[k] = -x_[k];
    }
  }

  /// What a variable adds to W r - u, which is -q.
  Eigen::VectorXd column(int variable) const {
    const int n = 2 * (variable / rays), ray = variable % rays;
    if (ray == parts) return -Eigen::VectorXd::Unit(size(), n);
    if (ray == slides_on) return -Eigen::VectorXd::Unit(size(), n + 1);
    if (ray == slides_back) return Eigen::VectorXd::Unit(size(), n + 1);
    const auto [along_n, along_t] = impulse_of_ray(variable);
    return along_n * W_.col(n) + along_t * W_.col(n + 1);
  }
  /// Of length 1; none of rays of velocities.
  std::array<double, 2> impulse_of_ray(int variable) const {
    const int ray = variable % rays;
    if (ray != forward && ray != backward) return {0, 0};
    const double mu = mu_[variable / rays], length = std::hypot(1, mu);
    return {1 / length, (ray == forward ? mu : -mu) / length};
  }

  /// The position whose value is first to reach 0 as values change at minus these rates; -1: none does.
  int first_to_leave(const Eigen::VectorXd& rates) const {
    const double rounding = 1e-11 * rates.cwiseAbs().maxCoeff();
    int found = -1;
    for (int k = 0; k < size(); ++k)
      if (rates[k] > rounding && (found < 0 || x_[k] / rates[k] < x_[found] / rates[found])) found = k;
    return found;
  }

  /// A variable takes a position of the basis; returns the one that leaves. `rates`: of the others, by its
  /// own.
  int enter(int variable, int place, const Eigen::VectorXd& rates) {
    const double value = x_[place] / rates[place];
    x_ = (x_ - value * rates).cwiseMax(0);  // below 0 by rounding alone
    x_[place] = value;
    const Eigen::RowVectorXd row = inverse_.row(place) / rates[place];
    inverse_.noalias() -= rates * row;
    inverse_.row(place) = row;
    return std::exchange(variables_[place], variable);
  }

  /// The ray on the other side of the one that a contact keeps where this one has left.
  int next_of(int left) const {
    const int a = left / rays;
    const int kept = *std::find_if(variables_.begin(), variables_.end(),
                                   [a](int variable) { return variable != z && variable / rays == a; });
    return rays * a + (2 * (kept % rays) - left % rays + rays) % rays;
  }

  Eigen::VectorXd impulses() const {
    Eigen::VectorXd r = Eigen::VectorXd::Zero(size());
    for (int k = 0; k < size(); ++k) {
      const int n = 2 * (variables_[k] / rays);
      const auto [along_n, along_t] = impulse_of_ray(variables_[k]);
      r[n] += along_n * x_[k], r[n + 1] += along_t * x_[k];
    }
    return r.cwiseProduct(unit_);
  }

  Eigen::MatrixXd W_;
  Eigen::VectorXd unit_, x_;  ///< x_: values of the basis
  std::span<const double> mu_;
  Eigen::MatrixXd inverse_;  ///< of the basis
  std::vector<int> variables_;
};

/// The contacts of a problem and which share a body that moves.
template <class Problem>
class Neighbourhood {
 public:
  explicit Neighbourhood(const Problem& problem)
      : problem_(problem), contacts_(problem.W.inverse_mass.size()), no_q_(problem.q.size(), 0.0) {
    const auto& W = problem.W;
    for (int a = 0; a < problem.contacts(); ++a)
      for (const auto body : {W.i[a], W.j[a]})
        if (W.inverse_mass[body] > 0) contacts_[body].push_back(a);
    W.rest(state_);
    u_ = no_q_;
  }

  /// Solves the contacts whose squared error is above this, with those around them, the worst first; returns
  /// the number of clusters solved.
  int settle(double allowed, Solution<Problem>& solution) {
    std::vector<std::pair<double, int>> wrong;
    for (int a = 0; a < problem_.contacts(); ++a) {
      const double error = squared_error(problem_, a, solution.impulses, solution.velocities.contacts);
      if (error > allowed) wrong.emplace_back(-error, a);
    }
    constexpr std::size_t part = 8;  // where more contacts than one in so many miss, sweeps are cheaper
    if (part * wrong.size() > static_cast<std::size_t>(problem_.contacts())) return 0;
    std::sort(wrong.begin(), wrong.end());
    std::vector<bool> open(problem_.contacts(), false);
    for (const auto& [error, a] : wrong)
      visit_around(a, [&](int b) { visit_around(b, [&](int c) { open[c] = true; }); });
    int solved = 0;
    for (const auto& [error, a] : wrong)
      if (open[a]) solved += solve(cluster(a, open), solution);
    return solved;
  }

 private:
  template <class Visit>
  void visit_around(int a, Visit visit) const {
    for (const auto body : {problem_.W.i[a], problem_.W.j[a]})
      for (const int b : contacts_[body]) visit(b);
  }

  /// Contact `a` and the nearest that are connected with it through `open` contacts, which are then no longer
  /// open; ascending.
  std::vector<int> cluster(int a, std::vector<bool>& open) const {
    constexpr std::size_t most_contacts = 70;
    std::vector<int> found{a};
    open[a] = false;
    for (std::size_t k = 0; k < found.size(); ++k)
      visit_around(found[k], [&](int b) {
        if (open[b] && found.size() < most_contacts) open[b] = false, found.push_back(b);
      });
    std::sort(found.begin(), found.end());
    return found;
  }

  /// Solves a cluster with the others as they stand; whether pivots did it.
  bool solve(const std::vector<int>& cluster, Solution<Problem>& solution) {
    constexpr int most_pivots = 10;  // a contact
    auto& [bodies, u] = solution.velocities;
    const auto size = static_cast<Eigen::Index>(2 * cluster.size());
    Eigen::VectorXd own_r(size), own_u(size);
    std::vector<double> mu;
    for (std::size_t k = 0; k < cluster.size(); ++k) {
      const int a = cluster[k];
      problem_.W.velocities_of(a, a + 1, problem_.q, bodies, u);
      mu.push_back(problem_.mu[a]);
      for (const int c : {0, 1})
        own_r[2 * k + c] = solution.impulses[2 * a + c], own_u[2 * k + c] = u[2 * a + c];
    }
    const Eigen::MatrixXd W = block(cluster);
    const auto r = solve_by_pivots(W, own_u - W * own_r, mu, most_pivots * static_cast<int>(cluster.size()));
    if (!r) return false;
    for (std::size_t k = 0; k < cluster.size(); ++k) {
      const auto held =
          contact_law::bounded(Coulomb{}, {mu[k]}, contact_law::numbers_at<2>(r->data() + 2 * k));
      for (const int c : {0, 1}) {
        push(bodies, cluster[k], c, held[c] - own_r[2 * k + c]);
        solution.impulses[2 * cluster[k] + c] = held[c];
      }
    }
    return true;
  }

  /// W of some contacts.
  Eigen::MatrixXd block(const std::vector<int>& cluster) {
    Eigen::MatrixXd W(2 * cluster.size(), 2 * cluster.size());
    for (std::size_t k = 0; k < cluster.size(); ++k)
      for (const int c : {0, 1}) {
        push(state_, cluster[k], c, 1);
        for (std::size_t l = 0; l < cluster.size(); ++l) {
          const int b = cluster[l];
          problem_.W.velocities_of(b, b + 1, no_q_, state_, u_);
          W(2 * l, 2 * k + c) = u_[2 * b], W(2 * l + 1, 2 * k + c) = u_[2 * b + 1];
        }
        push(state_, cluster[k], c, -1);
      }
    return W;
  }

  void push(typename Problem::Delassus::State& bodies, int a, int component, double size) const {
    const double n = component == 0 ? size : 0, t = size - n;
    problem_.W.push(bodies, a, {n, t});
  }

  const Problem& problem_;
  std::vector<std::vector<int>> contacts_;  ///< of each body that moves
  std::vector<double> no_q_, u_;
  typename Problem::Delassus::State state_;  ///< at rest between two calls
};

}  // namespace

std::optional<Eigen::VectorXd> solve_by_pivots(Eigen::MatrixXd W, Eigen::VectorXd q,
                                               std::span<const double> mu, int most_pivots) {
  return PivotPath(std::move(W), std::move(q), mu).impulses_at_end(most_pivots);
}

template <class Problem>
SolveReport settle_clusters(const Problem& problem, const StoppingRule& rule, Solution<Problem>& solution) {
  constexpr double gain = 0.9;  // of the residual, for which another round pays
  StoppingTest test(rule);
  Neighbourhood near(problem);
  ParallelLoops alone;
  const double allowed = rule.tolerance * rule.tolerance * squared_reference(problem, alone) /
                         static_cast<double>(problem.q.size());
  int solved = 0;
  double before = std::numeric_limits<double>::infinity();
  while (!test.ends(solved, residual_of(problem, solution)) && test.report().residual.rms < gain * before) {
    before = test.report().residual.rms;
    solved += near.settle(allowed, solution);
  }
  return test.report();
}

#define DRUMLIN_INSTANTIATE(Problem) \
  template SolveReport settle_clusters(const Problem&, const StoppingRule&, Solution<Problem>&);
DRUMLIN_INSTANTIATE(CoulombProblem)
DRUMLIN_INSTANTIATE(CoulombSpinProblem)
#undef DRUMLIN_INSTANTIATE

}  // namespace drumlin::particles
