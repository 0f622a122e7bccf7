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
#include "particles/solver/coarse_field.hpp"

namespace drumlin::particles {

/// Scales impulses; keeps workspace only. All ranks call its members together.
template <class Problem>
class TileCoarseLoads {
 public:
  static constexpr int dim = Problem::dim;
  static constexpr bool spin = requires(typename Problem::Delassus::Velocity v) { v.s; };

  TileCoarseLoads(const Ranks& ranks, ThreadTeam* team) : ranks_(ranks), loops_(team) {}
  /// Lays the nodes of the field over the bodies of a problem with so many contacts on all ranks.
  void lay_out(const Problem& problem, const TiledContacts& contacts, std::int64_t contacts_of_all);
  /// Scales the impulses in blocks, as they and the bodies stand, by factors between 1/2 and 2. False, and
  /// nothing scaled, where there is no good field.
  template <class T>
  bool scale(const TiledContacts& contacts, Halo& halo, TileBlocks<T, dim, spin>& blocks);

  /// Gives back the memory of what lay_out() has made.
  void release() { places_ = {}, moves_ = {}, power_ = {}; }

 private:
  template <class T>
  void move_bodies(const TiledContacts&, Halo&, TileBlocks<T, dim, spin>&);
  /// Bounds on the powers of the contacts, which it sets, and on the energies of the moves, on all ranks.
  template <class T>
  std::array<double, 2> find_bounds(const TiledContacts&, TileBlocks<T, dim, spin>&);
  /// Sums over contacts and bodies, of all ranks: of each node its entries of the matrix, then its right
  /// side.
  template <class T>
  std::vector<double> add_up(const TiledContacts&, TileBlocks<T, dim, spin>&);

  Ranks ranks_;
  TeamLoops loops_;
  FieldGrid grid_;
  std::int64_t terms_ = 1;  // bound on the number of terms of a sum
  std::vector<NodePlace> places_;
  std::vector<NodeMoves> moves_;
  std::vector<double> power_;  // of each place in the blocks
};

}  // namespace drumlin::particles
