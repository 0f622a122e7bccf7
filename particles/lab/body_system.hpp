#pragma once
// The linear system of bodies whose contacts answer linearly.
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "particles/contact/disc_delassus.hpp"
#include "particles/lab/sparse_lu.hpp"

namespace drumlin::particles {

/// How the impulse of one contact answers its velocity: dr = -D du. Friction at its bound follows the normal
/// impulse (tn), friction within it answers alone (tt).
struct ContactResponse {
  double nn = 0, tn = 0, tt = 0;
  bool operator==(const ContactResponse&) const = default;
};

/// The matrix 1 + G^T D G with G = H M^-1/2, so that W = G G^T: its unknowns are M^1/2 v of the bodies that
/// move, two or (with spin) three numbers each. They are scaled by the masses, which may differ a million
/// times. Throws InputError for walls that contacts push, and for cells under pressure.
template <int dim, bool with_spin>
class BodySystem {
 public:
  using Delassus = DiscDelassus<dim, with_spin>;
  static constexpr int numbers = with_spin ? 3 : 2;

  explicit BodySystem(const Delassus& W);

  int contacts() const { return static_cast<int>(ends_.size()); }
  int size() const { return lu_.pattern().size(); }
  /// M^-1/2 H^T r of dim numbers per contact.
  std::vector<double> momentum(std::span<const double> r) const;
  /// G x, dim numbers per contact.
  std::vector<double> velocities(std::span<const double> x) const;
  /// Factorises the matrix of these answers; false where it is singular.
  bool factorise(std::span<const ContactResponse> D);
  /// Solves with the last factors.
  std::vector<double> solution(std::span<const double> b) const;

 private:
  using Row = std::array<double, 2 * numbers>;
  struct Block {
    int first = -1, stride = 0;  ///< of its entries in the pattern, column by column; -1: of a fixed body
  };
  SparsePattern pattern_of(const Delassus& W);
  void set_rows(const Delassus& W);

  std::vector<std::array<int, 2>> ends_;      ///< first unknown of the two bodies of a contact, -1: fixed
  std::vector<Row> normal_, tangent_;         ///< rows of G
  std::vector<std::array<Block, 4>> blocks_;  ///< (i, i), (i, j), (j, i), (j, j) of each contact
  SparseLu lu_;
};

}  // namespace drumlin::particles
