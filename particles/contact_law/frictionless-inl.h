// Signorini's condition of one contact: 0 <= u_n, 0 <= r_n, u_n r_n = 0.
//
// u = W r + q is the relative velocity that belongs to the impulse r, W here the contact's own block of it.
// N is a number, or a vector of numbers of several contacts (laws.hpp, laws-inl.h, which include this).

/// The impulse that solves the contact with the others as they stand: in place of r, to which u belongs.
template <class N>
CONTACT_LAW std::array<N, 1> solved(Frictionless, const InverseBlock<N, 1>& W,
                                    const Coefficients<N, Frictionless>&, const std::array<N, 1>& u,
                                    const std::array<N, 1>& r) {
  return {positive_part(r[0] - u[0] * W.nn)};
}

/// The nearest impulse that the law allows.
template <class N>
CONTACT_LAW std::array<N, 1> projected(Frictionless, const Coefficients<N, Frictionless>&,
                                       const std::array<N, 1>& r) {
  return {positive_part(r[0])};
}

/// |r - P(r - rho u)|^2, 0 at a solution.
template <class N>
CONTACT_LAW N squared_natural_residual(Frictionless law, N rho, const Coefficients<N, Frictionless>& mu,
                                       const std::array<N, 1>& r, const std::array<N, 1>& u) {
  return squared_distance(projected(law, mu, std::array<N, 1>{r[0] - rho * u[0]}), r);
}

/// The same, component after component.
template <class N>
CONTACT_LAW std::array<N, 1> bounded(Frictionless law, const Coefficients<N, Frictionless>& mu,
                                     const std::array<N, 1>& r) {
  return projected(law, mu, r);
}
