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
#include "particles/distributed/tiled_contacts.hpp"
#include "particles/parallel/team_loops.hpp"
#include "particles/solver/coarse_field.hpp"

namespace drumlin::particles {

/// Scales impulses; keeps workspace only. All ranks call its members together.
template <class Problem>
class TileCoarseLoads {
 public:
  TileCoarseLoads(const Ranks& ranks, ThreadTeam* team) : ranks_(ranks), loops_(team) {}
  /// Lays the nodes of the field over the bodies of a problem with so many contacts on all ranks.
  void lay_out(const Problem& problem, const TiledContacts& contacts, std::int64_t contacts_of_all);
  /// Scales the impulses r, which cause the velocities u = W r + q of the contacts, by factors between 1/2
  /// and 2.
  void scale(const Problem& problem, const TiledContacts& contacts, Halo& halo, std::span<const double> u,
             std::vector<double>& r);

  /// Gives back the memory of what lay_out() has made.
  void release() { places_ = {}, moves_ = {}, power_ = {}; }

 private:
  static constexpr int dim = Problem::dim;
  static constexpr bool spin = requires(typename Problem::Delassus::Velocity v) { v.s; };
  /// Power that contact a has and should not.
  static double power(const Problem&, std::int32_t a, std::span<const double> u, std::span<const double> r);
  void move_bodies(const Problem&, const TiledContacts&, Halo&, std::span<const double> r);
  void push(const Problem&, std::int32_t a, std::span<const double> r);
  /// Bounds on the powers of the contacts, which it sets, and on the energies of the moves, on all ranks.
  std::array<double, 2> find_bounds(const Problem&, const TiledContacts&, std::span<const double> u,
                                    std::span<const double> r);
  /// Sums over contacts and bodies, of all ranks: of each node its entries of the matrix, then its right
  /// side.
  std::vector<double> add_up(const Problem&, const TiledContacts&, std::span<const double> u,
                             std::span<const double> r);

  Ranks ranks_;
  TeamLoops loops_;
  FieldGrid grid_;
  std::int64_t terms_ = 1;  // bound on the number of terms of a sum
  std::vector<NodePlace> places_;
  std::vector<NodeMoves> moves_;
  std::vector<double> power_;  // of each contact with an impulse
};

}  // namespace drumlin::particles
