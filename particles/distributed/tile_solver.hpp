#pragma once
// Solves a contact problem whose contacts are spread over ranks: Gauss-Seidel sweeps tile by tile in four
// colours, with the momentum of the default solver. The result is the same bytes for any number of ranks and
// threads.
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "particles/contact/problems.hpp"
#include "particles/contact/solution.hpp"
#include "particles/distributed/exact_sum.hpp"
#include "particles/distributed/halo.hpp"
#include "particles/distributed/ranks.hpp"
#include "particles/distributed/tile_blocks.hpp"
#include "particles/distributed/tile_coarse_loads.hpp"
#include "particles/distributed/tile_wave.hpp"
#include "particles/distributed/tiled_contacts.hpp"
#include "particles/parallel/team_loops.hpp"
#include "particles/solver/stopping_rule.hpp"
#include "particles/solver/sweep_wave.hpp"

namespace drumlin::particles {

/// As the solvers of these names on one process (solver/contact_solver.hpp).
enum class TileMethod { accelerated, accelerated_double, nlgs };

/// Workspace of solves of one kind of problem, made once per run.
template <class Problem>
class TileSolver {
 public:
  /// Problems of `least_corrected` contacts on all ranks, or more, are corrected on a coarse grid.
  TileSolver(const Ranks& ranks, ThreadTeam* team, std::int64_t least_corrected)
      : ranks_(ranks), loops_(team), coarse_(ranks, team), least_corrected_(least_corrected) {}

  /// Solves from the warm start in solution.impulses by one of the methods below. All ranks call it together;
  /// `problem` has the contacts of this rank alone. Velocities are set for all bodies that its contacts touch
  /// or it owns. The report is the same on all ranks, its time aside.
  SolveReport solve(const Problem& problem, const TiledContacts& contacts, Halo& halo,
                    const StoppingRule& rule, TileMethod method, Solution<Problem>& solution);
  /// Residual of the impulses in a solution, whose velocities it sets; the definition is that of
  /// residual_of().
  ContactResidual residual(const Problem& problem, const TiledContacts& contacts, Halo& halo,
                           Solution<Problem>& solution);
  /// Gives back the memory of the last solve; the next one asks for its own.
  void release() { in_single_ = {}, in_double_ = {}, coarse_.release(); }
  /// Coarse corrections since the program began.
  std::int64_t corrections() const { return corrections_; }

 private:
  static constexpr int dim = Problem::dim;
  using Delassus = typename Problem::Delassus;
  using Velocity = typename Delassus::Velocity;
  static constexpr bool spin = requires(Velocity v) { v.s; };

  template <class T>
  using Blocks = TileBlocks<T, dim, spin>;

  /// Calls work(t) for each tile, colour by colour, and exchanges what it has changed in the bodies that
  /// `get` gives and `set` takes.
  template <class Work, class Get, class Set>
  void work_on(const TileRounds&, Halo&, Work work, Get get, Set set);
  template <class T, class Work>
  void work_on(const TileRounds&, Halo&, Blocks<T>&, Work work);
  /// Velocities of bodies and contacts from the impulses in a solution.
  void set_velocities(const Problem&, const TiledContacts&, Halo&, Solution<Problem>&);
  /// Corrects the impulses in blocks on a coarse grid, laid out anew if this is the `first` time.
  template <class T>
  void correct_loads(const Problem&, const TiledContacts&, Halo&, bool first, std::int64_t contacts_of_all,
                     Blocks<T>&);
  /// Lets the bodies receive the velocities of the impulses.
  template <class T>
  void load_bodies(const TiledContacts&, Halo&, Blocks<T>&);
  /// Sweeps that are taken together, and their factors of momentum.
  template <class T>
  struct Wave {
    int sweeps = 1;
    std::array<T, longest_wave> betas{};
    SweepExtrapolation how = SweepExtrapolation::none;
  };
  template <class T>
  void take_wave(const TiledContacts&, Halo&, const Wave<T>&, Blocks<T>&);
  template <class T>
  void sweep_part(const TileOrder&, const Wave<T>&, int s, int strip, int phase, Blocks<T>&);
  template <class T>
  void begin_sweep(const TileStrip&, const Wave<T>&, int s, Blocks<T>&);
  std::array<double, longest_wave> steps_of_wave(int sweeps);
  template <class T>
  SolveReport sweep_until_done(const Problem&, const TiledContacts&, Halo&, const StoppingRule&,
                               std::int64_t contacts_of_all, Blocks<T>&, bool accelerated,
                               Solution<Problem>&);
  /// The estimate over the tiles of all ranks; they call it together.
  ResidualEstimate estimate_of_tiles();
  /// Those of all bodies; all ranks call it together.
  template <class T>
  double summed_impulses(const TiledContacts&, const Blocks<T>&);
  double scale_of(const Problem&, const TiledContacts&);

  Ranks ranks_;
  TeamLoops loops_;
  Blocks<float> in_single_;
  Blocks<double> in_double_;
  TileCoarseLoads<Problem> coarse_;
  std::int64_t least_corrected_, corrections_ = 0;
  bool steep_ = false;                                       ///< a contact of any rank is
  std::array<std::vector<double>, longest_wave> squares_;    // of the steps of each tile, by sweep of a wave
  std::array<std::optional<WavePlan>, longest_wave> plans_;  // of a solve, by the sweeps of a wave
  std::vector<ResidualEstimate> estimates_;                  // of each tile
};

}  // namespace drumlin::particles
