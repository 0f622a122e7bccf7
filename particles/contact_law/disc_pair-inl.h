// Two discs at a contact: the velocity u = H v that they have there, and what its impulse does to them. A
// disc has members x, z, the velocity of its centre, s = r omega, that of its rim, and inverse_mass.

/// The normal points from j to i; the tangent is (n_z, -n_x). `radius_ratio` is R_eff / r_i = r_j / (r_i +
/// r_j), 1 at a wall, and read with a couple alone.
template <class N>
struct ContactFrame {
  N n_x, n_z, radius_ratio;
};

/// The vector of an impulse.
template <std::size_t dim, class N>
CONTACT_LAW std::array<N, 2> impulse_vector(const ContactFrame<N>& at, const std::array<N, dim>& r) {
  N x = at.n_x * r[0], z = at.n_z * r[0];
  if constexpr (dim >= 2) x = x + at.n_z * r[1], z = z - at.n_x * r[1];
  return {x, z};
}

/// What a couple R_eff r_r changes of the rims of i and j, per r_r.
template <class N, class Disc>
CONTACT_LAW std::array<N, 2> turns_of(N radius_ratio, const Disc& I, const Disc& J) {
  return {number<N>(surface_gain) * I.inverse_mass * radius_ratio,
          number<N>(surface_gain) * J.inverse_mass * (number<N>(1) - radius_ratio)};
}

/// Adds an impulse on i, and its opposite on j. `spin`: friction turns them, by r J^-1 (-r r_t) both.
template <bool spin, std::size_t dim, class N, class Disc>
CONTACT_LAW void push(const ContactFrame<N>& at, const std::array<N, dim>& r, Disc& I, Disc& J) {
  const auto p = impulse_vector(at, r);
  I.x = I.x + I.inverse_mass * p[0], I.z = I.z + I.inverse_mass * p[1];
  J.x = J.x - J.inverse_mass * p[0], J.z = J.z - J.inverse_mass * p[1];
  if constexpr (spin && dim >= 2) {
    const N turns = number<N>(surface_gain) * r[1];
    I.s = I.s - I.inverse_mass * turns, J.s = J.s - J.inverse_mass * turns;
  }
  if constexpr (dim == 3) {
    const auto turns = turns_of(at.radius_ratio, I, J);
    I.s = I.s + turns[0] * r[2], J.s = J.s - turns[1] * r[2];
  }
}

/// H v where the centres have the relative velocity (d_x, d_z).
template <bool spin, std::size_t dim, class N, class Disc>
CONTACT_LAW std::array<N, dim> relative_velocity(const ContactFrame<N>& at, N d_x, N d_z, const Disc& I,
                                                 const Disc& J) {
  std::array<N, dim> u;
  u[0] = at.n_x * d_x + at.n_z * d_z;
  if constexpr (dim >= 2) u[1] = at.n_z * d_x - at.n_x * d_z;
  if constexpr (spin && dim >= 2) u[1] = u[1] - (I.s + J.s);
  if constexpr (dim == 3) u[2] = at.radius_ratio * I.s - (number<N>(1) - at.radius_ratio) * J.s;
  return u;
}
