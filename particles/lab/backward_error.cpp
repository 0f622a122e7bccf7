#include "particles/lab/backward_error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "particles/contact/residual.hpp"

namespace drumlin::particles {
namespace {

/// Relative to what a problem is: q and r.
struct Scale {
  double velocity = 0;  ///< rms of the entries of q
  double impulse = 0;   ///< mean r_n of the contacts that carry one
};

/// 0 stays 0 where there is nothing to compare with.
double relative(double value, double scale) {
  return value == 0 ? 0 : scale != 0 ? value / scale : std::numeric_limits<double>::infinity();
}

Scale scale_of(const BlockProblem& problem, std::span<const double> r) {
  Scale scale;
  scale.velocity = std::sqrt(squared_norm(problem.q) / static_cast<double>(problem.q.size()));
  int loaded = 0;
  for (int a = 0; a < problem.contacts(); ++a)
    if (r[2 * a] > 0) scale.impulse += r[2 * a], ++loaded;
  if (loaded > 0) scale.impulse /= loaded;
  return scale;
}

/// P_K(r - rho (u + mu |u_t| n)), contact by contact: impulses on the boundary or inside of their cones as
/// the velocities ask.
std::vector<double> natural_image(const BlockProblem& problem, std::span<const double> r,
                                  std::span<const double> u) {
  std::vector<double> image(r.size());
  for (int a = 0; a < problem.contacts(); ++a) {
    const double rho = 1 / problem.W.largest_eigenvalue(a), mu = problem.mu[a];
    const double n = r[2 * a] - rho * (u[2 * a] + mu * std::abs(u[2 * a + 1]));
    const auto nearest =
        contact_law::projected(Coulomb{}, {mu}, std::array{n, r[2 * a + 1] - rho * u[2 * a + 1]});
    image[2 * a] = nearest[0], image[2 * a + 1] = nearest[1];
  }
  return image;
}

std::vector<double> velocities_of(const BlockProblem& problem, std::span<const double> r) {
  BlockDelassus::State none;
  std::vector<double> u;
  problem.W.velocities(r, problem.q, none, u);
  return u;
}

/// The fewest of these, none negative, that make up 90 % of their sum.
int fewest_of_most(std::vector<double> squares, double sum) {
  std::sort(squares.begin(), squares.end(), std::greater<>());
  int count = 0;
  for (double found = 0; count < static_cast<int>(squares.size()) && found < 0.9 * sum; ++count)
    found += squares[count];
  return count;
}

BackwardError backward_error(const BlockProblem& problem, const Scale& scale, std::span<const double> r,
                             std::span<const double> u, double friction) {
  const int count = problem.contacts();
  std::vector<ContactState> states;
  const std::vector<double> dq = velocity_changes(problem, r, u, friction, states);
  BackwardError error;
  error.friction = friction;
  std::vector<double> squares(count);
  double sum = 0, normal = 0, impulses = 0, largest = 0;
  for (int a = 0; a < count; ++a) {
    squares[a] = dq[2 * a] * dq[2 * a] + dq[2 * a + 1] * dq[2 * a + 1];
    sum += squares[a];
    normal += dq[2 * a] * dq[2 * a];
    const double lambda = problem.W.largest_eigenvalue(a);
    impulses += squares[a] / (lambda * lambda);
    largest = std::max(largest, squares[a]);
    auto& state = error.states[static_cast<std::size_t>(states[a])];
    ++state.contacts;
    state.share += squares[a];
  }
  error.dq = relative(std::sqrt(sum / count), scale.velocity);
  error.dq_max = relative(std::sqrt(largest), scale.velocity);
  error.force = scale.impulse > 0 ? std::sqrt(impulses / count) / scale.impulse : 0;
  error.normal = sum > 0 ? normal / sum : 0;
  for (auto& state : error.states) state.share = sum > 0 ? state.share / sum : 0;
  if (std::isfinite(sum)) error.most_of_it = fewest_of_most(std::move(squares), sum);
  return error;
}

double distance(std::span<const double> r, std::span<const double> s, const Scale& scale) {
  double sum = 0;
  for (std::size_t k = 0; k < r.size(); ++k) sum += (r[k] - s[k]) * (r[k] - s[k]);
  return relative(std::sqrt(2 * sum / static_cast<double>(r.size())), scale.impulse);
}

}  // namespace

std::vector<double> velocity_changes(const BlockProblem& problem, std::span<const double> r,
                                     std::span<const double> u, double friction,
                                     std::vector<ContactState>& states) {
  constexpr double none = std::numeric_limits<double>::infinity();
  std::vector<double> dq(r.size(), 0.0);
  states.assign(problem.contacts(), ContactState::open);
  for (int a = 0; a < problem.contacts(); ++a) {
    const double n = r[2 * a], t = r[2 * a + 1], u_n = u[2 * a], u_t = u[2 * a + 1];
    const double weakest = problem.mu[a] * std::max(0.0, 1 - friction) * n;
    const double strongest = problem.mu[a] * (1 + friction) * n;
    if (!(n >= 0 && std::abs(t) <= strongest)) {
      dq[2 * a] = none;
    } else if (n == 0) {
      dq[2 * a] = std::max(0.0, -u_n);
    } else {
      dq[2 * a] = -u_n;
      // On the boundary of a cone that may be: sliding against r_t; either way where that is 0.
      const bool slides = std::abs(t) >= weakest && u_t != 0 && (t == 0 || (t > 0) != (u_t > 0));
      dq[2 * a + 1] = slides ? 0 : -u_t;
      states[a] = slides ? ContactState::sliding : ContactState::sticking;
    }
  }
  return dq;
}

std::vector<BackwardError> backward_errors(const BlockProblem& problem, std::span<const double> r,
                                           std::span<const double> friction) {
  if (problem.contacts() == 0) return std::vector<BackwardError>(friction.size());
  const Scale scale = scale_of(problem, r);
  const std::vector<double> u = velocities_of(problem, r);
  const std::vector<double> image = natural_image(problem, r, u), image_u = velocities_of(problem, image);
  const double dr = distance(image, r, scale);
  std::vector<BackwardError> errors;
  for (const double x : friction) {
    BackwardError as_it_is = backward_error(problem, scale, r, u, x);
    BackwardError of_image = backward_error(problem, scale, image, image_u, x);
    of_image.dr = dr;
    errors.push_back(of_image.dq < as_it_is.dq ? of_image : as_it_is);
  }
  return errors;
}

}  // namespace drumlin::particles
