#pragma once
// W_aa, a contact's own block of W, in double precision.
#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "particles/contact_law/laws.hpp"

namespace drumlin::particles {

/// Symmetric; W_nr = 0 always, W_nt = 0 but at driven walls that are pushed askew and in a cell.
struct LocalMatrix {
  double nn = 0, nt = 0, tt = 0, tr = 0, rr = 0;
};

/// Impulses or velocities of a contact, normal first.
template <int dim>
using ContactNumbers = std::array<double, static_cast<std::size_t>(dim)>;

template <int dim>
double largest_eigenvalue(const LocalMatrix& W) {
  if constexpr (dim == 1) {
    return W.nn;
  } else if constexpr (dim == 2) {
    return W.nt != 0 ? contact_law::larger_eigenvalue(W.nn, W.nt, W.tt) : std::max(W.nn, W.tt);
  } else {
    if (W.nt != 0) {
      const Eigen::Matrix3d whole{{W.nn, W.nt, 0}, {W.nt, W.tt, W.tr}, {0, W.tr, W.rr}};
      return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(whole, Eigen::EigenvaluesOnly).eigenvalues()[2];
    }
    return std::max(W.nn, contact_law::larger_eigenvalue(W.tt, W.tr, W.rr));
  }
}

/// A block with its inverse, as the laws take it.
template <int dim>
struct LocalBlock {
  LocalMatrix matrix;
  contact_law::InverseBlock<double, dim> inverse{};

  LocalBlock() = default;
  explicit LocalBlock(const LocalMatrix& W) : matrix(W) {
    inverse.nn = 1 / W.nn;
    if constexpr (dim >= 2) inverse.tt = 1 / W.tt;
    if constexpr (dim == 3) {
      inverse.rr = 1 / W.rr, inverse.tr = W.tr;
      inverse.tt_reduced = W.rr / (W.tt * W.rr - W.tr * W.tr);
    }
  }
};

/// One contact solved with the others as they stand, exactly where W_nt = 0; else friction follows the step
/// of the normal impulse, not the other way round. `u` are the velocities that belong to the impulses r.
template <class Law>
ContactNumbers<Law::unknowns> solved(Law law, const LocalBlock<Law::unknowns>& W,
                                     const contact_law::Coefficients<double, Law>& mu,
                                     ContactNumbers<Law::unknowns> u,
                                     const ContactNumbers<Law::unknowns>& r) {
  auto fresh = contact_law::solved(law, W.inverse, mu, u, r);
  if constexpr (Law::unknowns >= 2)
    if (W.matrix.nt != 0) {
      u[1] += W.matrix.nt * (fresh[0] - r[0]);
      fresh = contact_law::solved(law, W.inverse, mu, u, r);
    }
  return fresh;
}

}  // namespace drumlin::particles
