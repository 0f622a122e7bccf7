#pragma once
// The linear systems of the reference solver: one per form in which W is stored.
#include <span>
#include <vector>

#include "particles/contact/problems.hpp"
#include "particles/lab/block_delassus.hpp"
#include "particles/lab/body_system.hpp"

namespace drumlin::particles {

/// Solves (1 + D W) x = y for the numbers of all contacts. Returns an empty vector where the matrix is
/// singular. Keeps what depends on the contacts but not on D.
template <class Delassus>
class ResponseSystem;

/// Through the bodies: x = y - D H (M + H^T D H)^-1 H^T y (Woodbury), three unknowns per body.
template <int dim, bool with_spin>
class ResponseSystem<DiscDelassus<dim, with_spin>> {
 public:
  explicit ResponseSystem(const DiscDelassus<dim, with_spin>& W) : bodies_(W) {}
  std::vector<double> solution(std::span<const ContactResponse> D, std::span<const double> y);

 private:
  BodySystem<dim, with_spin> bodies_;
};

/// On the contacts themselves, two unknowns each.
template <>
class ResponseSystem<BlockDelassus> {
 public:
  explicit ResponseSystem(const BlockDelassus& W);
  std::vector<double> solution(std::span<const ContactResponse> D, std::span<const double> y);

 private:
  const BlockDelassus& W_;
  SparseLu transposed_;
};

}  // namespace drumlin::particles
