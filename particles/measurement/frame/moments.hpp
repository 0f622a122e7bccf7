#pragma once
// Moments of a region of a packing, and the fields that follow from them: one body for layers, rings, nodes
// of maps, boxes and the cells of single grains (docs/theory/measurement.md, docs/theory/coarse-graining.md).
// `D` dimensions: components 0, 1 are x, z in the plane. Of spheres, D = 3, areas are volumes.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <utility>

#include "coupling/core/basics/no_value.hpp"
#include "coupling/core/results/plane_invariants.hpp"

namespace drumlin::particles {

template <int D>
using Vector = std::array<double, D>;
template <int D>
using Tensor = std::array<Vector<D>, D>;

template <int D>
double length(const Vector<D>& v) {
  if constexpr (D == 2) return std::hypot(v[0], v[1]);
  return std::hypot(v[0], v[1], v[D - 1]);
}
template <int D>
double trace(const Tensor<D>& t) {
  double sum = 0;
  for (int a = 0; a < D; ++a) sum += t[a][a];
  return sum;
}

inline PlaneMatrix plane_matrix(const Tensor<2>& t) { return {t[0][0], t[0][1], t[1][0], t[1][1]}; }

/// A grain as a region sees it: places and velocities in the region's own axes.
template <int D>
struct GrainSample {
  std::size_t index = 0;
  Vector<D> at{}, velocity{};  ///< relative to the drum, over the stored window
  double radius = 0, density = 1, contacts = 0, spin = 0;
  Vector<D> laboratory_velocity{},
      force{};       ///< of this instant; of all its contacts: maps alone ask for them
  double depth = 0;  ///< of the slab of spheres in which this one is seen; 0: a disc, D = 3: a sphere alone

  bool is_sphere() const { return D == 3 || depth > 0; }
  /// A volume in space, per depth of a slab.
  double area() const {
    const double disc = std::numbers::pi * radius * radius;
    return is_sphere() ? per_depth(disc * 4 * radius / 3) : disc;
  }
  double per_depth(double volume) const { return depth > 0 ? volume / depth : volume; }
  double mass() const { return density * area(); }
  /// J spin^2 / 2, J = m r^2 / 2, of spheres 2 m r^2 / 5.
  double spin_energy() const {
    if (is_sphere()) return mass() * radius * radius * spin * spin / 5;
    return density * (std::numbers::pi / 4 * (radius * radius) * (radius * radius) * spin * spin);
  }
};

/// One grain's side of a contact: from its centre to the contact. Both sides together are the branch; across
/// a periodic boundary each stays with its grain, and a wall has none.
template <int D>
struct HalfBranch {
  std::uint32_t grain = 0;
  Vector<D> at{};        ///< centre of the grain
  Vector<D> toward{};    ///< from the centre to the contact
  Vector<D> force{};     ///< on the grain
  Vector<D> normal{};    ///< along `toward` or against it, of length 1 in single precision
  bool at_wall = false;  ///< the other side is a wall
  double radius = 0;     ///< of a sphere in a slab, whose `toward` and `normal` are shorter; 0: of a disc

  Vector<D> point(double share) const {
    Vector<D> result = at;
    for (int a = 0; a < D; ++a) result[a] += share * toward[a];
    return result;
  }
};

/// Weighted sums over vectors of N components: of 1, of each component and of the products of two.
template <int N>
struct Spread {
  double weight = 0;
  std::array<double, N> first{};
  std::array<double, N*(N + 1) / 2> second{};  ///< a <= b, row after row

  void add(double times, const std::array<double, N>& q) {
    weight += times;
    for (std::size_t a = 0, k = 0; a < N; ++a) {
      const double of_a = times * q[a];
      first[a] += of_a;
      for (std::size_t b = a; b < N; ++b) second[k++] += of_a * q[b];
    }
  }
  /// NaN without weight, as the covariance.
  double mean(std::size_t a) const { return weight > 0 ? first[a] / weight : no_value; }
  double product(std::size_t a, std::size_t b) const {
    const auto [low, high] = std::minmax(a, b);
    return second[low * N - low * (low + 1) / 2 + high];
  }
  double covariance(std::size_t a, std::size_t b) const {
    return weight > 0 ? product(a, b) / weight - first[a] / weight * (first[b] / weight) : no_value;
  }
};

/// Sums over the grains and half branches of a region, each with its weight there. `N`: D when the spread is
/// that of velocities, 2 D when it is that of velocities and, behind them, places.
template <int D, int N = D>
struct Moments {
  double solid = 0;                            ///< area of grains in the region
  double grains = 0, contacts = 0, spin = 0;   ///< of the grains with their centres in it
  Spread<N> motion;                            ///< of the same, by their mass
  Tensor<D> force_branch{};                    ///< F_a b_b: F on the grain, b from the contact to its centre,
                                               ///< so that repulsion counts positive
  std::array<double, D*(D + 1) / 2> fabric{};  ///< n_a n_b, a <= b

  void add_centre(double weight, const GrainSample<D>& grain) {
    grains += weight;
    contacts += weight * grain.contacts;
    spin += weight * grain.spin;
  }
  void add_share(double share, const HalfBranch<D>& branch) {
    for (int a = 0; a < D; ++a)
      for (int b = 0; b < D; ++b) force_branch[a][b] -= share * branch.force[a] * branch.toward[b];
  }
  /// Contacts between grains.
  void add_end(double weight, const HalfBranch<D>& branch) {
    if (!branch.at_wall) add_fabric(weight, branch.normal);
  }
  void add_fabric(double weight, const Vector<D>& normal) {
    for (int a = 0, k = 0; a < D; ++a)
      for (int b = a; b < D; ++b) fabric[k++] += weight * normal[a] * normal[b];
  }
};

/// What the sums of a region do not know of it.
template <int D>
struct Background {
  double area = 1;
  Tensor<D> gradient{};                ///< d v_a/d x_b of the mean motion, which is no fluctuation
  std::optional<double> density = {};  ///< mass per area of what moves; without it that of the sums
};

/// Means that every table has of its regions, whatever their axes. A new one is a member, its name in
/// `shared_fields` and its line in derive(); docs/formats/quantities.md has its words.
struct SharedFields {
  double coordination = no_value, temperature_over_p = no_value;
};
constexpr std::pair<const char*, double SharedFields::*> shared_fields[] = {
    {"coordination", &SharedFields::coordination}, {"temperature_over_p", &SharedFields::temperature_over_p}};

/// Means over a region. NaN where there is nothing to take them of, but no motion is no kinetic stress.
template <int D>
struct Fields : SharedFields {
  double nu = 0, omega = no_value;
  Tensor<D> contact{}, kinetic{};  ///< parts of the stress, compression positive
  Tensor<D> fabric{};              ///< its trace is 1

  Tensor<D> pressure() const {
    Tensor<D> sum = contact;
    for (int a = 0; a < D; ++a)
      for (int b = 0; b < D; ++b) sum[a][b] += kinetic[a][b];
    return sum;
  }
};

/// Covariance of two components of the velocity about a mean motion with a gradient; about one velocity where
/// the sums know no places.
template <int D, int N>
double fluctuation(const Spread<N>& motion, const Tensor<D>& gradient, int a, int b) {
  double sum = motion.covariance(a, b);
  if constexpr (N == 2 * D)
    for (int c = 0; c < D; ++c) {
      sum -= gradient[a][c] * motion.covariance(D + c, b) + gradient[b][c] * motion.covariance(a, D + c);
      for (int e = 0; e < D; ++e) sum += gradient[a][c] * gradient[b][e] * motion.covariance(D + c, D + e);
    }
  return a == b ? std::max(0.0, sum) : sum;  // by rounding no variance falls below zero
}

template <int D, int N>
Fields<D> derive(const Moments<D, N>& m, const Background<D>& background) {
  Fields<D> f;
  f.nu = m.solid / background.area;
  f.omega = m.spin / m.grains;
  f.coordination = m.contacts / m.grains;
  const double density = background.density.value_or(m.motion.weight / background.area);
  double sides = 0;
  for (int a = 0, k = 0; a < D; k += D - a++) sides += m.fabric[k];
  for (int a = 0, k = 0; a < D; ++a)
    for (int b = a; b < D; ++b, ++k)
      f.fabric[a][b] = f.fabric[b][a] = sides > 0 ? m.fabric[k] / sides : no_value;
  for (int a = 0; a < D; ++a)
    for (int b = 0; b < D; ++b) {
      f.contact[a][b] = m.force_branch[a][b] / background.area;
      if (m.motion.weight > 0)
        f.kinetic[a][b] = density * fluctuation<D>(m.motion, background.gradient, a, b);
    }
  if (const double p = trace<D>(f.pressure()); p > 0) f.temperature_over_p = trace<D>(f.kinetic) / (f.nu * p);
  return f;
}

}  // namespace drumlin::particles
