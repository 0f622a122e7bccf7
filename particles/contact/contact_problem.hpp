#pragma once
// One contact problem: find r with u = W r + q, u_n and r_n complementary, and r_t by the law.
// The paper, Eq. (3): W r - u = b with b = -q; q is the free relative velocity with the shifts of the impact
// law.
#include <algorithm>
#include <vector>

#include "particles/contact_law/laws.hpp"

namespace drumlin::particles {

/// `Delassus` says how W is stored: through the bodies (DiscDelassus, in time stepping) or as sparse blocks
/// (BlockDelassus, from a file). Entries of contact a stand at dim * a, normal first (parts_of()).
template <class Delassus_, class Law_>
struct ContactProblem {
  using Delassus = Delassus_;
  using Law = Law_;
  static constexpr int dim = Law::unknowns;
  static_assert(dim == Delassus::dim);

  Delassus W;
  std::vector<double> q;
  std::vector<double> mu;  ///< the coefficients of the law of each contact, as contact_laws-inl.h names them
  double time_step = 1;    ///< turns -u_n into a predicted penetration
  double rounding = 0;     ///< a velocity far above what rounding leaves in q, far below those of grains

  int contacts() const { return static_cast<int>(q.size()) / dim; }
  contact_law::Coefficients<double, Law> coefficients(int a) const {
    return contact_law::numbers_at<Law::coefficients>(mu.data() + Law::coefficients * a);
  }
};

/// The parts of an impulse, or a velocity, of contact a; 0 where the law has none.
struct ContactParts {
  double normal = 0, tangential = 0, couple = 0;
};
template <class Problem>
ContactParts parts_of(const std::vector<double>& numbers, std::size_t a) {
  constexpr std::size_t dim = Problem::dim;
  const double* const of = numbers.data() + dim * a;
  return {of[0], dim >= 2 ? of[1 % dim] : 0, dim == 3 ? of[2 % dim] : 0};
}

/// Whether a contact has a steep coefficient.
template <class Problem>
bool is_steep(const Problem& problem) {
  return std::any_of(problem.mu.begin(), problem.mu.end(), [](double mu) { return contact_law::steep(mu); });
}

}  // namespace drumlin::particles
