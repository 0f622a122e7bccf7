// Signorini, Coulomb and rolling resistance of one contact: r in the cone K = {|r_t| <= mu r_n, |r_r| <= mu_r
// r_n}; r_t opposes sliding, r_r rolling. Components (normal, tangential, rolling). The rolling velocity is
// R_eff (omega_i - omega_j) with 1/R_eff = 1/r_i + 1/r_j, a wall counting as flat, so that r_r is an impulse
// and R_eff r_r its couple (Estrada, Azema, Radjai, Taboada 2011).

/// The impulse that solves the contact with the others as they stand: first the normal, then friction and
/// rolling together, the minimum of a strictly convex quadratic over a box: friction as if rolling were free,
/// clamped; rolling for that, clamped; friction for that. Where friction leaves the box first, rolling along
/// that edge is right, or friction along the edge of rolling is.
template <class N>
CONTACT_LAW std::array<N, 3> solved(CoulombRolling, const InverseBlock<N, 3>& W,
                                    const Coefficients<N, CoulombRolling>& mu, const std::array<N, 3>& u,
                                    const std::array<N, 3>& r) {
  N n = positive_part(r[0] - u[0] * W.nn);
  if (const N most = larger(mu[0], mu[1]); any(steep(most), most)) {
    const N slide = step_fraction(mu[0], r[0], r[1], n, r[1] - u[1] * W.tt);
    const N roll = step_fraction(mu[1], r[0], r[2], n, r[2] - u[2] * W.rr);
    n = positive_part(r[0] - u[0] * (W.nn * smaller(slide, roll)));
  }
  const N bound = mu[0] * n;
  const N first = clamped(r[1] - (u[1] - W.tr * (W.rr * u[2])) * W.tt_reduced, bound);
  const N roll = clamped(r[2] - W.rr * (u[2] + W.tr * (first - r[1])), mu[1] * n);
  return {n, clamped(r[1] - W.tt * (u[1] + W.tr * (roll - r[2])), bound), roll};
}

/// The nearest impulse in K. For given n the best t and r are clamped; the derivative of what is left,
/// n' - n - mu (|t| - mu n')+ - mu_r (|r| - mu_r n')+, rises and is the least of four lines (each of t and r
/// clamped or not), so that its zero is the largest of theirs.
template <class N>
CONTACT_LAW std::array<N, 3> projected(CoulombRolling, const Coefficients<N, CoulombRolling>& mu,
                                       const std::array<N, 3>& r) {
  const N one = number<N>(1), mu_2 = mu[0] * mu[0], mu_r_2 = mu[1] * mu[1];
  const N with_t = mu[0] * absolute(r[1]), with_r = mu[1] * absolute(r[2]);
  N n = positive_part(r[0]);
  n = larger(n, (r[0] + with_t) / (one + mu_2));
  n = larger(n, (r[0] + with_r) / (one + mu_r_2));
  n = larger(n, (r[0] + with_t + with_r) / (one + mu_2 + mu_r_2));
  return {n, clamped(r[1], mu[0] * n), clamped(r[2], mu[1] * n)};
}

/// r_n >= 0, then the others within the bounds that this gives.
template <class N>
CONTACT_LAW std::array<N, 3> bounded(CoulombRolling, const Coefficients<N, CoulombRolling>& mu,
                                     const std::array<N, 3>& r) {
  const N n = positive_part(r[0]);
  return {n, clamped(r[1], mu[0] * n), clamped(r[2], mu[1] * n)};
}

/// As with friction alone; the shift of u_n is mu |u_t| + mu_r |u_r|.
template <class N>
CONTACT_LAW N squared_natural_residual(CoulombRolling law, N rho, const Coefficients<N, CoulombRolling>& mu,
                                       const std::array<N, 3>& r, const std::array<N, 3>& u) {
  const N t = r[1] - rho * u[1], roll = r[2] - rho * u[2];
  const N shifted = u[0] + mu[0] * absolute(u[1]) + mu[1] * absolute(u[2]);
  N error = squared_distance(projected(law, mu, std::array<N, 3>{r[0] - rho * shifted, t, roll}), r);
  if (const N most = larger(mu[0], mu[1]); any(steep(most), most))
    error = where(steep(most),
                  squared_distance(bounded(law, mu, std::array<N, 3>{r[0] - rho * u[0], t, roll}), r), error);
  return error;
}
