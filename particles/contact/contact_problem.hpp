#pragma once
// One contact problem: find r with u = W r + q, u_n and r_n complementary, r_t in Coulomb's law.
// The paper, Eq. (3): W r - u = b with b = -q; q is the free relative velocity with the shifts of the impact
// law.
#include <algorithm>
#include <vector>

#include "particles/contact_law/laws.hpp"

namespace drumlin::particles {

/// `Delassus` says how many unknowns a contact has, and how W is stored: through the bodies (DiscDelassus, in
/// time stepping) or as sparse blocks (BlockDelassus, from a file). Entries of contact a stand at dim * a,
/// normal first.
template <class Delassus_>
struct ContactProblem {
  using Delassus = Delassus_;
  static constexpr int dim = Delassus::dim;

  Delassus W;
  std::vector<double> q;
  std::vector<double> mu;  ///< the coefficients of the law, dim - 1 per contact
  double time_step = 1;    ///< turns -u_n into a predicted penetration
  double rounding = 0;     ///< a velocity far above what rounding leaves in q, far below those of grains

  int contacts() const { return static_cast<int>(q.size()) / dim; }
  contact_law::Coefficients<double, dim> coefficients(int a) const {
    return contact_law::numbers_at<dim - 1>(mu.data() + (dim - 1) * a);
  }
};

/// Whether a contact has a steep coefficient.
template <class Problem>
bool is_steep(const Problem& problem) {
  return std::any_of(problem.mu.begin(), problem.mu.end(), [](double mu) { return contact_law::steep(mu); });
}

}  // namespace drumlin::particles
