#pragma once
// What contacts and bodies add to the matrix and the right side of the coarse field
// (particles/solver/coarse_loads.hpp). Innermost loops, for the two files that add them up.
#include <Eigen/Core>
#include <array>
#include <cmath>

#include "particles/solver/coarse_field.hpp"
#include "particles/solver/sweep_kernels.hpp"

namespace drumlin::particles {

/// The four entries of a move as one vector.
inline auto vector_of(NodeMove& move) {
  return Eigen::Map<Eigen::Array4f, Eigen::Aligned16>(move.entries.data());
}
inline auto vector_of(const NodeMove& move) {
  return Eigen::Map<const Eigen::Array4f, Eigen::Aligned16>(move.entries.data());
}

/// The power g_a that a contact with friction mu has and should not; without friction r_t = u_t = 0.
inline double power_of(double r_n, double u_n, double r_t, double u_t, double mu) {
  constexpr double sliding = 1e-6;  // so near to its bound, in parts of that, a tangential impulse slides
  const double bound = r_n * mu;
  return r_n * u_n + (r_t * u_t + (std::abs(r_t) >= bound * (1 - sliding) ? bound * std::abs(u_t) : 0));
}

/// Impulse of a contact on its first body, and where that is: the weights of its nodes.
struct NodePush {
  NodePush(double n_x, double n_z, double r_n, double r_t, bool spin, const NodePlace& place)
      : at(place),
        weights(Eigen::Array4d::Map(place.weights().data()).cast<float>()),
        x(static_cast<float>(n_x * r_n + n_z * r_t)),
        z(static_cast<float>(n_z * r_n - n_x * r_t)),
        s(static_cast<float>(spin ? -2 * r_t : 0)) {}

  /// Adds what it does to a body; `sign`: -1 of the second one.
  void add_to(NodeMoves& moves, const NodePlace& own, double inverse_mass, float sign) const {
    const Eigen::Array4f change = static_cast<float>(inverse_mass) * Eigen::Array4f(sign * x, sign * z, s, 0);
    // Of the lower left node around the contact.
    NodeMove* const first = &moves[3 * (at.row - own.next_row + 1) + at.column - own.next_column + 1];
    vector_of(first[0]) += weights[0] * change, vector_of(first[1]) += weights[1] * change;
    vector_of(first[3]) += weights[2] * change, vector_of(first[4]) += weights[3] * change;
  }

  const NodePlace& at;
  const Eigen::Array4f weights;
  const float x, z, s;
};

/// A contact of a block, as impulses and bodies stand.
template <class T, int dim, bool spin>
struct CoarseContact {
  CoarseContact(const ContactBlock<T, dim>& block, int k)
      : i(block.i[k] / sizeof(BodyRecord<T>)),
        j(block.j[k] / sizeof(BodyRecord<T>)),
        n_x(block.n_x[k]),
        n_z(block.n_z[k]),
        r_n(block.r[0][k]) {
    if constexpr (dim == 2) r_t = block.r[1][k];
  }
  /// See power_of().
  double power(const ContactBlock<T, dim>& block, int k, const BodyRecord<T>* bodies) const {
    const BodyRecord<T>&I = bodies[i], &J = bodies[j];
    const double d_x = I.x - J.x, d_z = I.z - J.z, u_n = block.q[0][k] + (n_x * d_x + n_z * d_z);
    if constexpr (dim == 1)
      return power_of(r_n, u_n, 0, 0, 0);
    else {
      double u_t = block.q[1][k] + (n_z * d_x - n_x * d_z);
      if constexpr (spin) u_t -= I.s + J.s;
      return power_of(r_n, u_n, r_t, u_t, block.mu[k]);
    }
  }
  /// Adds what its impulse does to its bodies.
  void move(const NodePlace* places, const BodyRecord<T>* bodies, NodeMoves* moves) const {
    const NodePush push(n_x, n_z, r_n, r_t, spin, places[i]);
    push.add_to(moves[i], places[i], bodies[i].inverse_mass, 1);
    if (bodies[j].inverse_mass > 0) push.add_to(moves[j], places[j], bodies[j].inverse_mass, -1);
  }

  std::size_t i, j;  ///< records of its bodies
  double n_x, n_z, r_n, r_t = 0;
};

/// Multiplies the impulses of blocks by the factors of a field where their first bodies are; momentum rests.
template <class T, int dim>
void scale_blocks(std::span<ContactBlock<T, dim>> blocks, const FieldGrid& grid, const NodePlace* places,
                  std::span<const double> field) {
  for (auto& block : blocks)
    for (int k = 0; k < block.width; ++k) {
      if (block.r[0][k] > 0) {
        const auto factor =
            static_cast<T>(factor_at(grid, places[block.i[k] / sizeof(BodyRecord<T>)], field));
        for (int e = 0; e < dim; ++e) block.r[e][k] *= factor;
      }
      for (int e = 0; e < dim; ++e) block.before[e][k] = block.r[e][k];
    }
}

/// Of m v . v' + J omega omega' of two moves, with J = m r^2 / 2 and s = r omega, all but the mass: of the
/// first what weighted() makes of it.
inline Eigen::Array4f weighted(const NodeMove& v) { return vector_of(v) * Eigen::Array4f(1, 1, 0.5F, 0); }
inline double product(const Eigen::Array4f& weighted_v, const NodeMove& w) {
  return static_cast<double>((weighted_v * vector_of(w)).sum());
}

/// Calls visit(node, entry, energy) for the scalar products of what the hats of two nodes do to a body.
template <class Visit>
void each_product(const FieldGrid& grid, const NodePlace& at, const NodeMoves& moves, double mass,
                  Visit visit) {
  std::array<int, 9> moved{};
  int count = 0;
  for (int k = 0; k < 9; ++k)
    if ((vector_of(moves[k]) != 0).any()) moved[count++] = k;
  for (int m = 0; m < count; ++m) {
    const int k = moved[m], node = grid.neighbour(at, k);
    const Eigen::Array4f v = weighted(moves[k]);
    for (int n = m; n < count; ++n) {
      const int l = moved[n];
      visit(node, 5 * (l / 3 - k / 3) + l % 3 - k % 3, mass * product(v, moves[l]));
    }
  }
}

}  // namespace drumlin::particles
