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

/// How the grid stands in the forest. The curve of p4est goes first along x; where it is to go first along z,
/// the forest has x and z exchanged. Its first cut is across the middle of the forest, which has twice the
/// grid's edge, so that any line of squares can lie there.
struct Placing {
  bool exchanged = false;
  std::int32_t middle = 0;  ///< columns of squares before the first cut; rows, unless exchanged
  dealii::Point<2> in_forest(Point p) const {
    return exchanged ? dealii::Point<2>(p.z, p.x) : dealii::Point<2>(p.x, p.z);
  }
  Point outside(const dealii::Point<2>& p) const { return exchanged ? Point{p[1], p[0]} : Point{p[0], p[1]}; }
};

/// A packing that is wider than high is cut into columns: the first cut halves its weight, or leaves up to a
/// column more for what comes after, whose squares next to the cut are then the first that the curve gives to
/// those before it.
Placing placing_for(const TileGrid& grid, std::span<const std::int64_t> weights) {
  const std::int64_t empty = *std::min_element(weights.begin(), weights.end());
  std::array<std::vector<std::int64_t>, 2> of_line;  // of each column of squares, and of each row
  of_line.fill(std::vector<std::int64_t>(grid.rows(), 0));
  for (std::int32_t tile = 0; tile < grid.count(); ++tile) {
    of_line[0][grid.column(tile) / grid.cut] += weights[tile];
    of_line[1][grid.row(tile)] += weights[tile];
  }
  const std::int64_t of_empty_line = empty * grid.columns();  // a line of either kind has so many tiles
  const auto extent = [&](const std::vector<std::int64_t>& lines) {
    const auto holds = [&](std::int64_t weight) { return weight > of_empty_line; };
    const auto last = std::find_if(lines.rbegin(), lines.rend(), holds).base();
    return last - std::find_if(lines.begin(), last, holds);
  };
  const bool wide = extent(of_line[0]) >= extent(of_line[1]);
  const std::vector<std::int64_t>& lines = of_line[wide ? 0 : 1];
  const std::int64_t all = std::accumulate(lines.begin(), lines.end(), std::int64_t{0});
  std::int32_t middle = 0;
  for (std::int64_t before = lines[0]; 2 * before <= all && middle + 1 < grid.rows();)
    before += lines[++middle];
  return {wide, middle};
}

template <class Particle>
RankGrain record_of(const Particle& particle, const Placing& placing) {
  const Point place = placing.outside(particle.get_location());
  const auto own = particle.get_properties();
  return {
      static_cast<std::int64_t>(particle.get_id()), place.x, place.z, own[0], own[1], own[2], own[3], own[4]};
}

}  // namespace

struct Forest::Library {
  /// Cells of the grid's size are in the grid alone: around it they are as large as p4est lets them be.
  Library(const TileGrid& grid_, const Placing& placing_)
      : grid(grid_), placing(placing_), triangulation(MPI_COMM_WORLD), mapping(1) {
    Point corner = grid.origin;
    (placing.exchanged ? corner.x : corner.z) += 2 * grid.cell * (placing.middle - grid.rows());
    const dealii::Point<2> low = placing.in_forest(corner);
    const double edge = 2 * grid.edge();
    dealii::GridGenerator::hyper_rectangle(triangulation, low,
                                           dealii::Point<2>(low[0] + edge, low[1] + edge));
    for (int level = 0; level <= grid.levels; ++level) {
      for (const Cell& cell : triangulation.active_cell_iterators())
        if (cell->is_locally_owned() && overlaps_grid(cell)) cell->set_refine_flag();
      triangulation.execute_coarsening_and_refinement();
    }
  }

  bool overlaps_grid(const Cell& cell) const {
    const Point p = middle(cell);
    const double reach = cell->extent_in_direction(0) / 2 - grid.cell / 4;  // more than rounding inside
    const auto overlap = [&](double along) { return along > -reach && along < grid.edge() + reach; };
    return overlap(p.x - grid.origin.x) && overlap(p.z - grid.origin.z);
  }
  Point middle(const Cell& cell) const { return placing.outside(cell->center()); }
  bool owns_in_grid(const Cell& cell) const {
    return cell->is_locally_owned() && grid.contains(middle(cell));
  }
  std::int32_t square_of(const Cell& cell) const { return grid.first_of_square(middle(cell)); }
  /// Number of the cell of a point.
  std::int64_t cell_at(Point p) const {
    const auto along = [&](double d) {
      return static_cast<std::int64_t>(
          std::clamp(std::floor(d / grid.cell), 0.0, grid.cells_per_side() - 1.0));
    };
    return along(p.z - grid.origin.z) * grid.cells_per_side() + along(p.x - grid.origin.x);
  }

  void find_outside(std::int64_t id, Point place) {
    if (outside.id < 0 || id < outside.id) outside = {id, place.x, place.z};
  }

  TileGrid grid;
  Placing placing;
  Triangulation triangulation;
  dealii::MappingQ<2> mapping;
  Handler handler;
  GrainOutside outside;  // of the last move, on this rank
};

Forest::Forest(const Ranks& ranks, const TileGrid& grid, std::span<const std::int64_t> weights)
    : ranks_(ranks) {
  tiles_.grid = grid;
  if (ranks.count() == 1) {
    tiles_.owner.assign(grid.count(), 0);
    return;
  }
  library_ = std::make_unique<Library>(grid, placing_for(grid, weights));
  Library& lib = *library_;
  {
    const auto weighed = lib.triangulation.signals.weight.connect(
        [&](const Triangulation::cell_iterator& cell, const Triangulation::CellStatus) {
          const Point middle = lib.placing.outside(cell->center());
          if (!grid.contains(middle)) return 1U;
          const std::int32_t first = grid.first_of_square(middle);
          const std::int64_t weight =
              std::accumulate(weights.begin() + first, weights.begin() + first + grid.cut, std::int64_t{0});
          return static_cast<unsigned int>(std::min<std::int64_t>(weight, 1 << 20));
        });
    lib.triangulation.repartition();
    weighed.disconnect();
  }
  tiles_.owner.assign(grid.count(), -1);
  std::vector<std::int32_t> own;
  std::vector<int> cells(grid.count(), 0);
  for (const Cell& cell : lib.triangulation.active_cell_iterators())
    if (lib.owns_in_grid(cell) && ++cells[lib.square_of(cell)] == 1) own.push_back(lib.square_of(cell));
  for (const std::int32_t tile : own)
    if (cells[tile] != 4) throw std::logic_error("a square of cells is cut between two ranks");
  std::vector<std::vector<std::int32_t>> to_all(ranks.count(), own);
  const auto of_ranks = ranks.exchange(to_all);
  for (std::size_t r = 0; r < of_ranks.size(); ++r)
    for (const std::int32_t first : of_ranks[r])
      std::fill_n(tiles_.owner.begin() + first, grid.cut, static_cast<std::int32_t>(r));
  lib.handler.initialize(lib.triangulation, lib.mapping, properties);
  lib.handler.signals.particle_lost.connect([&lib](const auto& particle, const auto&) {
    lib.find_outside(static_cast<std::int64_t>(particle->get_id()),
                     lib.placing.outside(particle->get_location()));
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

/// On one rank: grains in the order of their tiles, so that neighbours stand together in memory.
GrainOutside Forest::keep_all(std::span<const RankGrain> grains) {
  GrainOutside outside;
  std::vector<std::int32_t> tile(grains.size()), next(tiles_.grid.count() + 1, 0);
  for (std::size_t k = 0; k < grains.size(); ++k) {
    const RankGrain& grain = grains[k];
    const Point place{grain.x, grain.z};
    if (!tiles_.grid.contains(place)) {
      if (outside.id < 0 || grain.id < outside.id) outside = {grain.id, grain.x, grain.z};
      continue;
    }
    tile[k] = tiles_.grid.tile_at(place);
    ++next[tile[k] + 1];
  }
  if (outside.id >= 0) return outside;
  std::partial_sum(next.begin(), next.end(), next.begin());
  owned_.resize(grains.size());
  for (std::size_t k = 0; k < grains.size(); ++k) owned_[next[tile[k]]++] = grains[k];
  return outside;
}

GrainOutside Forest::place(std::span<const RankGrain> grains) {
  if (!library_) return keep_all(grains);
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
    if (lib.owns_in_grid(cell)) cells[lib.cell_at(lib.middle(cell))] = cell;
  lib.handler.clear_particles();
  const double edge = tiles_.grid.cell;
  for (const auto& of_rank : ranks_.exchange(to_rank))
    for (const RankGrain& grain : of_rank) {
      const Cell& cell = cells[lib.cell_at({grain.x, grain.z})];
      const dealii::Point<2> place = lib.placing.in_forest({grain.x, grain.z});
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

void Forest::clear() {
  if (library_) library_->handler.clear_particles();
  owned_ = {}, ghosts_ = {};
}

GrainOutside Forest::move(std::span<const RankGrain> grains) {
  if (!library_) return keep_all(grains);
  Library& lib = *library_;
  lib.outside = {};
  std::size_t k = 0;
  for (auto& particle : lib.handler) {
    const RankGrain& grain = grains[k++];
    const Point place{grain.x, grain.z};
    if (lib.grid.contains(place))
      particle.set_location(lib.placing.in_forest(place));
    else
      lib.find_outside(grain.id, place);  // the library shall not look for its cell
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
  for (const auto& particle : lib.handler) owned_.push_back(record_of(particle, lib.placing));
  for (auto particle = lib.handler.begin_ghost(); particle != lib.handler.end_ghost(); ++particle)
    ghosts_.push_back({record_of(*particle, lib.placing),
                       static_cast<std::int32_t>(particle->get_surrounding_cell()->subdomain_id())});
}

}  // namespace drumlin::particles
