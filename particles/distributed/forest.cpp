#include "particles/distributed/forest.hpp"

#include <deal.II/distributed/tria.h>
#include <deal.II/fe/mapping_q.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/particles/particle_handler.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace drumlin::particles {
namespace {

using Triangulation = dealii::parallel::distributed::Triangulation<2>;
using Handler = dealii::Particles::ParticleHandler<2>;
using Cell = Triangulation::active_cell_iterator;

constexpr unsigned int properties = 5;  // velocities, spin, radius, inverse mass

std::array<double, properties> properties_of(const RankGrain& g) {
  return {g.v_x, g.v_z, g.spin, g.radius, g.inverse_mass};
}

/// The curve of p4est goes first along x. Where it is to go first along z, the forest has x and z exchanged.
struct Axes {
  bool exchanged = false;
  dealii::Point<2> in_forest(Point p) const {
    return exchanged ? dealii::Point<2>(p.z, p.x) : dealii::Point<2>(p.x, p.z);
  }
  Point outside(const dealii::Point<2>& p) const { return exchanged ? Point{p[1], p[0]} : Point{p[0], p[1]}; }
};

/// A packing that is wider than high is cut into columns.
Axes axes_for(const TileGrid& grid, std::span<const std::int64_t> weights) {
  const std::int64_t empty = *std::min_element(weights.begin(), weights.end());
  std::array<std::int32_t, 2> low{grid.rows(), grid.rows()}, high{0, 0};
  for (std::int32_t tile = 0; tile < grid.count(); ++tile) {
    if (weights[tile] == empty) continue;
    const std::array<std::int32_t, 2> at{grid.column(tile) / grid.cut, grid.row(tile)};
    for (const int axis : {0, 1})
      low[axis] = std::min(low[axis], at[axis]), high[axis] = std::max(high[axis], at[axis]);
  }
  return {high[0] - low[0] >= high[1] - low[1]};
}

template <class Particle>
RankGrain record_of(const Particle& particle, const Axes& axes) {
  const Point place = axes.outside(particle.get_location());
  const auto own = particle.get_properties();
  return {
      static_cast<std::int64_t>(particle.get_id()), place.x, place.z, own[0], own[1], own[2], own[3], own[4]};
}

}  // namespace

struct Forest::Library {
  Library(const TileGrid& grid_, const Axes& axes_)
      : grid(grid_), axes(axes_), triangulation(MPI_COMM_WORLD), mapping(1) {
    const dealii::Point<2> low = axes.in_forest(grid.origin);
    dealii::GridGenerator::hyper_rectangle(triangulation, low,
                                           dealii::Point<2>(low[0] + grid.edge(), low[1] + grid.edge()));
    triangulation.refine_global(grid.levels);
  }

  Point middle(const Cell& cell) const { return axes.outside(cell->center()); }
  std::int32_t square_of(const Cell& cell) const { return grid.first_of_square(middle(cell)); }
  /// Number of the cell of a point.
  std::int64_t cell_at(Point p) const {
    const auto along = [&](double d) {
      return static_cast<std::int64_t>(
          std::clamp(std::floor(d / grid.cell), 0.0, grid.cells_per_side() - 1.0));
    };
    return along(p.z - grid.origin.z) * grid.cells_per_side() + along(p.x - grid.origin.x);
  }

  TileGrid grid;
  Axes axes;
  Triangulation triangulation;
  dealii::MappingQ<2> mapping;
  Handler handler;
  GrainOutside outside;  // of the last move, on this rank
};

Forest::Forest(const Ranks& ranks, const TileGrid& grid, std::span<const std::int64_t> weights)
    : ranks_(ranks), library_(std::make_unique<Library>(grid, axes_for(grid, weights))) {
  Library& lib = *library_;
  {
    const auto weighed = lib.triangulation.signals.weight.connect(
        [&](const Triangulation::cell_iterator& cell, const Triangulation::CellStatus) {
          const std::int32_t first = grid.first_of_square(lib.axes.outside(cell->center()));
          const std::int64_t weight =
              std::accumulate(weights.begin() + first, weights.begin() + first + grid.cut, std::int64_t{0});
          return static_cast<unsigned int>(std::min<std::int64_t>(weight, 1 << 20));
        });
    if (ranks.count() > 1) lib.triangulation.repartition();
    weighed.disconnect();
  }
  tiles_.grid = grid;
  tiles_.owner.assign(grid.count(), -1);
  std::vector<std::int32_t> own;
  std::vector<int> cells(grid.count(), 0);
  for (const Cell& cell : lib.triangulation.active_cell_iterators())
    if (cell->is_locally_owned() && ++cells[lib.square_of(cell)] == 1) own.push_back(lib.square_of(cell));
  for (const std::int32_t tile : own)
    if (cells[tile] != 4) throw std::logic_error("a square of cells is cut between two ranks");
  std::vector<std::vector<std::int32_t>> to_all(ranks.count(), own);
  const auto of_ranks = ranks.exchange(to_all);
  for (std::size_t r = 0; r < of_ranks.size(); ++r)
    for (const std::int32_t first : of_ranks[r])
      std::fill_n(tiles_.owner.begin() + first, grid.cut, static_cast<std::int32_t>(r));
  lib.handler.initialize(lib.triangulation, lib.mapping, properties);
  lib.handler.signals.particle_lost.connect([&lib](const auto& particle, const auto&) {
    const auto id = static_cast<std::int64_t>(particle->get_id());
    if (lib.outside.id >= 0 && lib.outside.id <= id) return;
    const Point place = lib.axes.outside(particle->get_location());
    lib.outside = {id, place.x, place.z};
  });
}

Forest::~Forest() = default;

GrainOutside Forest::first_outside(const GrainOutside& own) const {
  constexpr std::int64_t none = std::numeric_limits<std::int64_t>::max();
  const std::int64_t first = ranks_.least(own.id < 0 ? none : own.id);
  if (first == none) return {};
  // Two ranks cannot lose the same grain.
  std::vector<GrainOutside> mine;
  if (own.id == first) mine.push_back(own);
  return ranks_.gather_everywhere<GrainOutside>(mine).front();
}

GrainOutside Forest::place(std::span<const RankGrain> grains) {
  Library& lib = *library_;
  GrainOutside outside;
  std::vector<std::vector<RankGrain>> to_rank(ranks_.count());
  for (const RankGrain& grain : grains) {
    if (!tiles_.grid.contains({grain.x, grain.z})) {
      if (outside.id < 0 || grain.id < outside.id) outside = {grain.id, grain.x, grain.z};
      continue;
    }
    to_rank[tiles_.owner_at({grain.x, grain.z})].push_back(grain);
  }
  outside = first_outside(outside);
  if (outside.id >= 0) return outside;
  std::vector<Cell> cells(static_cast<std::size_t>(tiles_.grid.cells_per_side()) *
                          tiles_.grid.cells_per_side());
  for (const Cell& cell : lib.triangulation.active_cell_iterators())
    if (cell->is_locally_owned()) cells[lib.cell_at(lib.middle(cell))] = cell;
  lib.handler.clear_particles();
  const double edge = tiles_.grid.cell;
  for (const auto& of_rank : ranks_.exchange(to_rank))
    for (const RankGrain& grain : of_rank) {
      const Cell& cell = cells[lib.cell_at({grain.x, grain.z})];
      const dealii::Point<2> place = lib.axes.in_forest({grain.x, grain.z});
      const auto& corner = cell->vertex(0);
      const auto own = properties_of(grain);
      lib.handler.insert_particle(
          place, dealii::Point<2>((place[0] - corner[0]) / edge, (place[1] - corner[1]) / edge),
          static_cast<dealii::types::particle_index>(grain.id), cell,
          dealii::ArrayView<const double>(own.data(), own.size()));
    }
  lib.handler.update_cached_numbers();
  lib.handler.exchange_ghost_particles();
  read_back();
  return {};
}

GrainOutside Forest::move(std::span<const RankGrain> grains) {
  Library& lib = *library_;
  lib.outside = {};
  std::size_t k = 0;
  for (auto& particle : lib.handler) {
    const RankGrain& grain = grains[k++];
    particle.set_location(lib.axes.in_forest({grain.x, grain.z}));
    const auto own = properties_of(grain);
    particle.set_properties(dealii::ArrayView<const double>(own.data(), own.size()));
  }
  lib.handler.sort_particles_into_subdomains_and_cells();
  const GrainOutside outside = first_outside(lib.outside);
  if (outside.id >= 0) return outside;
  lib.handler.exchange_ghost_particles();
  read_back();
  return {};
}

void Forest::read_back() {
  Library& lib = *library_;
  owned_.clear(), ghosts_.clear();
  for (const auto& particle : lib.handler) owned_.push_back(record_of(particle, lib.axes));
  for (auto particle = lib.handler.begin_ghost(); particle != lib.handler.end_ghost(); ++particle)
    ghosts_.push_back({record_of(*particle, lib.axes),
                       static_cast<std::int32_t>(particle->get_surrounding_cell()->subdomain_id())});
}

}  // namespace drumlin::particles
