// Signorini's condition and Coulomb's law of one contact: r in the cone K = {|r_t| <= mu r_n}; where it
// slides, |r_t| = mu r_n and r_t opposes u_t. Components (normal, tangential).

/// Where mu is steep, the part of its step that the normal impulse takes; else 1. `whole` is the normal
/// impulse of the whole step, `free` the tangential one without its bound. The friction of a contact that
/// slides follows the normal impulse mu-fold and neighbours answer to it: whole steps would swing for ever.
template <class N>
CONTACT_LAW N step_fraction(N mu, N n, N t, N whole, N free) {
  const N one = number<N>(1);
  const auto slides = both(greater(n, number<N>(0)), not_less(absolute(t), number<N>(0.999) * (mu * n)));
  const auto will_slide = not_less(absolute(free), mu * whole);
  return where(both(steep(mu), either(slides, will_slide)), one / mu, one);
}

/// The impulse that solves the contact with the others as they stand: first the normal, then friction.
template <class N>
CONTACT_LAW std::array<N, 2> solved(Coulomb, const InverseBlock<N, 2>& W, const Coefficients<N, Coulomb>& mu,
                                    const std::array<N, 2>& u, const std::array<N, 2>& r) {
  const N free = r[1] - u[1] * W.tt;
  N n = positive_part(r[0] - u[0] * W.nn);
  if (any(steep(mu[0]), mu[0]))
    n = positive_part(r[0] - u[0] * (W.nn * step_fraction(mu[0], r[0], r[1], n, free)));
  return {n, clamped(free, mu[0] * n)};
}

/// The nearest impulse in K. A NaN stays one.
template <class N>
CONTACT_LAW std::array<N, 2> projected(Coulomb, const Coefficients<N, Coulomb>& mu,
                                       const std::array<N, 2>& r) {
  const N size = absolute(r[1]), above = positive_part(r[0]);
  const N along = positive_part(r[0] + mu[0] * size) / (number<N>(1) + mu[0] * mu[0]);  // ray or tip
  const auto inside = not_greater(size, mu[0] * above);
  return {where(inside, above, along), where(inside, r[1], with_sign_of(mu[0] * along, r[1]))};
}

/// r_n >= 0, then r_t within the bound that this gives.
template <class N>
CONTACT_LAW std::array<N, 2> bounded(Coulomb, const Coefficients<N, Coulomb>& mu, const std::array<N, 2>& r) {
  const N n = positive_part(r[0]);
  return {n, clamped(r[1], mu[0] * n)};
}

/// |r - P(r - rho (u + mu |u_t| n))|^2 with De Saxce's shift along the normal n, 0 at a solution. Where mu is
/// steep the shift would count an error of u_t mu-fold: there the parts are projected in turn.
template <class N>
CONTACT_LAW N squared_natural_residual(Coulomb law, N rho, const Coefficients<N, Coulomb>& mu,
                                       const std::array<N, 2>& r, const std::array<N, 2>& u) {
  const N t = r[1] - rho * u[1];
  const N shifted = r[0] - rho * (u[0] + mu[0] * absolute(u[1]));
  N error = squared_distance(projected(law, mu, std::array<N, 2>{shifted, t}), r);
  if (any(steep(mu[0]), mu[0]))
    error = where(steep(mu[0]), squared_distance(bounded(law, mu, std::array<N, 2>{r[0] - rho * u[0], t}), r),
                  error);
  return error;
}

/// What friction takes of the power mu r_n |u_t| of a contact that slides, its r_t within a millionth of the
/// bound; 0 where it sticks.
template <class N>
CONTACT_LAW N sliding_power(const Coefficients<N, Coulomb>& mu, const std::array<N, 2>& r,
                            const std::array<N, 2>& u) {
  const N bound = mu[0] * r[0], nearly = number<N>(1) - number<N>(1e-6);
  return where(not_less(absolute(r[1]), bound * nearly), bound * absolute(u[1]), number<N>(0));
}
