// The laws of one contact, written once over the type of numbers. Included within a namespace that has the
// operations on them: laws.hpp, laws-inl.h.

/// Friction above this is steep: what a step of the normal impulse does to friction outweighs the step
/// itself.
inline constexpr double steep_friction = 1;

/// Coefficients of a law, as contact_laws-inl.h names them.
template <class N, class Law>
using Coefficients = std::array<N, static_cast<std::size_t>(Law::coefficients)>;

/// What a law needs of W_aa, the contact's own block of dim rows.
template <class N, std::size_t dim>
struct InverseBlock;
template <class N>
struct InverseBlock<N, 1> {
  N nn;  ///< 1 / W_nn
};

template <class N>
struct InverseBlock<N, 2> {
  N nn, tt;  ///< 1 / W_nn, 1 / W_tt; W_nt = 0, as of discs
};

template <class N>
struct InverseBlock<N, 3> {
  N nn, tt, rr;  ///< 1 / W_nn, 1 / W_tt, 1 / W_rr; W_nt = W_nr = 0
  N tr;          ///< W_tr itself
  N tt_reduced;  ///< 1 / (W_tt - W_tr^2 / W_rr): friction with free rolling
};

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

/// The larger eigenvalue of a symmetric block of two rows: a, b; b, c.
template <class N>
CONTACT_LAW N larger_eigenvalue(N a, N b, N c) {
  const N half = number<N>(0.5), mean = half * (a + c), off = half * (a - c);
  return mean + square_root(off * off + b * b);
}

#include "particles/contact_law/disc_pair-inl.h"
// After it: they use it.
#include "particles/contact_law/contact_laws-inl.h"
