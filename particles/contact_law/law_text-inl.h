// The laws of one contact, written once over the type of numbers. Included within a namespace that has the
// operations on them: numbers.hpp, numbers-inl.h.

/// Friction above this is steep: what a step of the normal impulse does to friction outweighs the step
/// itself.
inline constexpr double steep_friction = 1;

/// Coefficients of a law of dim unknowns, one for each but the normal one.
template <class N, std::size_t dim>
using Coefficients = std::array<N, dim - 1>;

/// What a law needs of W_aa, the contact's own block.
template <class N, std::size_t dim>
struct InverseBlock;

template <class N>
CONTACT_LAW auto steep(N mu) {
  return greater(mu, number<N>(steep_friction));
}

template <class N, std::size_t dim>
CONTACT_LAW N squared_distance(const std::array<N, dim>& a, const std::array<N, dim>& b) {
  N sum = (a[0] - b[0]) * (a[0] - b[0]);
  for (std::size_t e = 1; e < dim; ++e) sum = sum + (a[e] - b[e]) * (a[e] - b[e]);
  return sum;
}

#include "particles/contact_law/coulomb-inl.h"
#include "particles/contact_law/coulomb_rolling-inl.h"
#include "particles/contact_law/disc_pair-inl.h"
#include "particles/contact_law/frictionless-inl.h"
