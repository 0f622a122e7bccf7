#pragma once
// The linear systems of the reference solver: one per form in which W is stored.
#include <Eigen/Sparse>
#include <span>
#include <vector>

#include "particles/contact/problems.hpp"

namespace drumlin::particles {

/// How the impulse of one contact answers its velocity: dr = -D du. Friction at its bound follows the normal
/// impulse (tn), friction within it answers alone (tt).
struct ContactResponse {
  double nn = 0, tn = 0, tt = 0;
  bool operator==(const ContactResponse&) const = default;
};

/// Solves (1 + D W) x = y for the numbers of all contacts. Returns an empty vector where the matrix is
/// singular. Keeps what depends on the contacts but not on D.
template <class Delassus>
class ResponseSystem;

/// Through the bodies: x = y - D H (M + H^T D H)^-1 H^T y (Woodbury), three unknowns per body, sparse LU.
template <class Cone, bool with_spin>
class ResponseSystem<BodyDelassus<Cone, with_spin>> {
 public:
  using Delassus = BodyDelassus<Cone, with_spin>;
  explicit ResponseSystem(const Delassus& W);
  std::vector<double> solution(std::span<const ContactResponse> D, std::span<const double> y);

 private:
  static constexpr int dim = Delassus::dim, numbers = with_spin ? 3 : 2;
  void assemble(std::span<const ContactResponse> D);

  const Delassus& W_;
  std::vector<int> place_;  ///< of a body among those that move, -1: held
  int bodies_ = 0;
  bool analysed_ = false;
  Eigen::SparseMatrix<double> matrix_;
  Eigen::SparseLU<Eigen::SparseMatrix<double>, Eigen::AMDOrdering<int>> factors_;
};

/// On the contacts themselves, two unknowns each.
template <>
class ResponseSystem<BlockDelassus> {
 public:
  explicit ResponseSystem(const BlockDelassus& W) : W_(W) {}
  std::vector<double> solution(std::span<const ContactResponse> D, std::span<const double> y);

 private:
  const BlockDelassus& W_;
};

}  // namespace drumlin::particles
