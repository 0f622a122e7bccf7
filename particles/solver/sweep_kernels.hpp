#pragma once
// The innermost loops of the contact solvers, on vectors: one binary holds them for several instruction sets
// and picks at run time. All of them do the same operations in the same order, without fused multiply-add, so
// that results do not depend on the processor.
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <stdexcept>

#include "particles/solver/momentum.hpp"
#include "particles/solver/residual_estimate.hpp"

namespace drumlin::particles {

template <class T, int count>
struct CoefficientsOfBlock {
  std::array<std::array<T, 8>, static_cast<std::size_t>(count)> mu;  ///< in the order of the law
};
template <class T>
struct CoefficientsOfBlock<T, 0> {};
/// `radius_ratio` as in DiscDelassus; with W = (W_tt W_tr; W_tr W_rr), `inverse_W_rr` is 1 / W_rr and
/// `inverse_W_tt` that of W_tt - W_tr^2 / W_rr, friction with the couple eliminated.
template <class T, int dim>
struct CoupleOfBlock {};
template <class T>
struct CoupleOfBlock<T, 3> {
  std::array<T, 8> radius_ratio, inverse_W_rr, inverse_W_tt;
};

/// Eight contacts that share no body.
template <class T, class Law>
struct alignas(64) ContactBlock : CoefficientsOfBlock<T, Law::coefficients>, CoupleOfBlock<T, Law::unknowns> {
  static constexpr int width = 8, dim = Law::unknowns;
  std::array<std::uint32_t, width> i, j;  ///< where the records of the bodies begin, in bytes
  std::array<T, width> n_x, n_z, inverse_W_nn;
  std::array<std::array<T, width>, dim> q, r;
  std::array<std::array<T, width>, dim>
      before;  ///< r after the sweep before the last, where momentum needs it
};

/// Velocity change of a body: x, z, the tangential velocity of its rim, and the inverse mass that turns
/// impulses into these. One record is one load.
template <class T>
struct alignas(4 * sizeof(T)) BodyRecord {
  T x = 0, z = 0, s = 0, inverse_mass = 0;
};

/// Blocks count the bytes before a record in 32 bits. Throws std::length_error where that is not enough.
template <class T>
void require_offsets(std::size_t records) {
  if (records > std::numeric_limits<std::uint32_t>::max() / sizeof(BodyRecord<T>))
    throw std::length_error("more bodies than a sweep can count");
}

/// Kernels of one kind of problem; `spin`: bodies turn.
template <class T, class Law, bool spin>
struct SweepKernels {
  using Block = ContactBlock<T, Law>;
  /// Adds the impulses of the blocks to the bodies.
  static void load(const Block* blocks, std::size_t count, BodyRecord<T>* bodies);
  /// One Gauss-Seidel sweep over the blocks in their order. Each of the `groups` is a number of successive
  /// blocks that share no body, so that the bodies of the next one are loaded before those of this one are
  /// stored. Extrapolated, it
  /// starts from r + beta (r - before), and `before` becomes r. Returns the sum of squares of the steps of
  /// the impulses. Double precision rounds what it extrapolates.
  static double sweep(Block* blocks, std::span<const std::int32_t> groups, BodyRecord<T>* bodies, T beta,
                      SweepExtrapolation);
  /// The residual of the blocks as they stand.
  static ResidualEstimate residual(const Block* blocks, std::size_t count, const BodyRecord<T>* bodies);
  /// The same going on for bodies.
  static void go_on(BodyRecord<T>* bodies, BodyRecord<T>* before, std::size_t count, T beta);
};

}  // namespace drumlin::particles
