#pragma once
// The forest of cells on all ranks, and the grains in it: who owns which, who sees which. Wraps deal.II's
// parallel::distributed::Triangulation and Particles::ParticleHandler, which no other file of the particles
// sees.
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "particles/distributed/ranks.hpp"
#include "particles/distributed/tiles.hpp"

namespace drumlin::particles {

/// A grain as it travels between ranks.
struct RankGrain {
  std::int64_t id = 0;
  double x = 0, z = 0, v_x = 0, v_z = 0, spin = 0, radius = 0, inverse_mass = 0;
};

/// A grain that another rank owns.
struct GhostRecord {
  RankGrain grain;
  std::int32_t owner = 0;
};

/// A grain outside of the grid or, with more ranks than one, in no cell near the one that it left.
struct GrainOutside {
  std::int64_t id = -1;  ///< -1: none
  double x = 0, z = 0;
};

/// The cells of all ranks, who owns which tile, and the grains in them. On one rank all are its own, and
/// deal.II is not used.
class Forest {
 public:
  /// Cuts the grid among the ranks along a space-filling curve, squares of 2 x 2 cells whole, by the weights
  /// of the tiles (one for each, at least 1).
  Forest(const Ranks& ranks, const TileGrid& grid, std::span<const std::int64_t> weights);
  ~Forest();
  Forest(const Forest&) = delete;
  Forest& operator=(const Forest&) = delete;

  const TileMap& tiles() const { return tiles_; }
  const Ranks& ranks() const { return ranks_; }
  /// Sends each grain to the rank that owns its tile. Returns the first of all that lies outside of the grid;
  /// the forest must then not be used.
  GrainOutside place(std::span<const RankGrain> grains);
  /// Holds no grains any more, until place().
  void clear();
  /// Gives the grains of take_owned(), in that order, new places and velocities, and sends those that have
  /// left the rank to their new owners. Returns as place().
  GrainOutside move(std::span<const RankGrain> grains);

  /// Grains of this rank, once after each place() or move(): the forest keeps no copy.
  std::vector<RankGrain> take_owned() { return std::exchange(owned_, {}); }
  /// Grains of others within one layer of cells around those of this rank.
  const std::vector<GhostRecord>& ghosts() const { return ghosts_; }

 private:
  struct Library;
  GrainOutside keep_all(std::span<const RankGrain> grains);
  void read_back();
  GrainOutside first_outside(const GrainOutside& own) const;

  Ranks ranks_;
  TileMap tiles_;
  std::unique_ptr<Library> library_;  // none: one rank
  std::vector<RankGrain> owned_;
  std::vector<GhostRecord> ghosts_;
};

}  // namespace drumlin::particles
