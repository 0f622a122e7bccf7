#pragma once
// Coarse correction of the impulses of a large packing that is spread over ranks: the field of
// particles/solver/coarse_loads.hpp, which scales them. Its matrix and its right side are sums of integers,
// so that they depend neither on ranks nor on threads; all ranks solve for the field.
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "particles/contact/problems.hpp"
#include "particles/distributed/ranks.hpp"
#include "particles/distributed/tile_blocks.hpp"
#include "particles/distributed/tiled_contacts.hpp"
#include "particles/parallel/team_loops.hpp"
#include "particles/solver/coarse_kernels.hpp"

namespace drumlin::particles {

/// Scales impulses; keeps workspace only. All ranks call its members together.
template <class Problem>
class TileCoarseLoads {
 public:
  static constexpr int dim = Problem::dim;
  static constexpr bool spin = requires(typename Problem::Delassus::Velocity v) { v.s; };

  TileCoarseLoads(const Ranks& ranks, ThreadTeam* team) : ranks_(ranks), loops_(team) {}
  /// Lays the nodes of the field over the bodies of a problem, which has been packed, with so many contacts
  /// on all ranks.
  template <class T>
  void lay_out(const Problem& problem, const TiledContacts& contacts, std::int64_t contacts_of_all,
               const TileBlocks<T, dim, spin>& blocks);
  /// Scales the impulses in blocks, as they and the bodies stand, by factors between 1/2 and 2. False, and
  /// nothing scaled, where there is no good field.
  template <class T>
  bool scale(const TiledContacts& contacts, Halo& halo, TileBlocks<T, dim, spin>& blocks);

  /// Gives back the memory of what lay_out() has made.
  void release() { records_ = {}; }

 private:
  template <class T>
  using Vector = std::vector<T>;
  template <class T>
  void add_contacts(const TiledContacts&, Halo&, TileBlocks<T, dim, spin>&);
  /// Of the powers of bodies and of what they add to the matrix, on all ranks.
  template <class T>
  std::array<double, 2> bounds(const TiledContacts&, const TileBlocks<T, dim, spin>&);
  /// Sums over bodies, of all ranks: of each node its entries of the matrix, then its right side.
  template <class T>
  std::vector<double> add_up(const TiledContacts&, const TileBlocks<T, dim, spin>&);

  Ranks ranks_;
  TeamLoops loops_;
  FieldGrid grid_;
  std::int64_t terms_ = 1;  // bound on the number of terms of a sum
  CoarseRecords<Vector> records_;
};

}  // namespace drumlin::particles
