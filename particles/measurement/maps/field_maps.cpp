#include "particles/measurement/maps/field_maps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "coupling/exchange/plane_invariants.hpp"
#include "particles/measurement/frame/intervals.hpp"
#include "particles/measurement/maps/displacement_maps.hpp"
#include "particles/measurement/maps/spline_kernel.hpp"

namespace drumlin::particles {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// The makers of rows, with memory that they use again.
class RowMaker {
 public:
  RowMaker(const MapBatches& batches, double container_radius)
      : batches_(batches),
        container_radius_(container_radius),
        total_(batches.total()),
        known_(known_fields(total_)),
        motion_(batches),
        left_out_(batches.size() > 1 ? batches.size() : 0) {
    for (std::size_t b = 0; b < left_out_.size(); ++b) {
      shares_.push_back(total_);
      shares_.back().take(batches.share(b));
    }
  }

  /// Sets the nodes of one row of tiles.
  const MapRows& rows(std::size_t tile_row, std::size_t row_count) {
    const std::size_t columns = batches_.graining().grid.columns;
    rows_.first_row = tile_row * edge;
    rows_.rows = std::min(edge, row_count - rows_.first_row);
    clear(rows_.rows * columns);
    const std::size_t across = NodeTiles<MapNode>::tiles_along(columns);
    for (std::size_t t = 0; t < across; ++t) {
      batches_.read(tile_row * across + t, tile_);
      const std::size_t end = std::min(edge, columns - t * edge);
      for (std::size_t row = 0; row < rows_.rows; ++row)
        for (std::size_t column = 0; column < end; ++column)
          set_node(row * edge + column, t * edge + column, row);
    }
    return rows_;
  }

 private:
  static constexpr std::size_t edge = NodeTiles<MapNode>::edge;

  void clear(std::size_t nodes) {
    const bool with_intervals = !left_out_.empty();
    rows_.fields.resize(known_.size());
    for (std::size_t f = 0; f < known_.size(); ++f) {
      rows_.fields[f].name = known_[f].name;
      rows_.fields[f].value.assign(nodes, none);
      if (with_intervals) rows_.fields[f].ci99.assign(nodes, none);
    }
    motion_.add_empty_fields(nodes, rows_.fields);
    rows_.without.resize(left_out_.size());
    for (FrictionRows& without : rows_.without)
      for (auto* values : {&without.nu, &without.p, &without.I, &without.mu}) values->assign(nodes, none);
  }

  /// Share of the kernel at a node that lies within the container, 1 without one; 0 for a node outside.
  double share_inside(std::size_t column, std::size_t row) const {
    if (!(container_radius_ > 0)) return 1;
    const MapGrid& grid = batches_.graining().grid;
    const double x = grid.x_of(column), z = grid.z_of(row);
    if (std::hypot(x, z) > container_radius_) return 0;
    return kernel_share_in_circle(x, z, batches_.graining().width, container_radius_);
  }

  /// `place` within the tile; `row` counts from the first one of the tile.
  void set_node(std::size_t place, std::size_t column, std::size_t row) {
    const double inside = share_inside(column, rows_.first_row + row);
    if (inside == 0) return;
    const std::size_t at = row * batches_.graining().grid.columns + column;
    NodeSums sum = tile_.sums(0, place);
    for (std::size_t b = 1; b < batches_.size(); ++b) sum += tile_.sums(b, place);
    const MapValues whole = values_at(sum, total_, inside);
    for (std::size_t f = 0; f < known_.size(); ++f) rows_.fields[f].value[at] = whole.*known_[f].value;
    for (std::size_t b = 0; b < left_out_.size(); ++b) {
      NodeSums rest = sum;
      rest -= tile_.sums(b, place);
      const MapValues& values = left_out_[b] = values_at(rest, shares_[b], inside);
      FrictionRows& without = rows_.without[b];
      without.nu[at] = values.nu;
      without.p[at] = values.p;
      without.I[at] = values.I;
      without.mu[at] = values.mu;
    }
    set_intervals(whole, at);
    motion_.set_node(tile_, place, whole, at, std::span(rows_.fields).subspan(known_.size()));
  }

  void set_intervals(const MapValues& whole, std::size_t at) {
    if (left_out_.empty()) return;
    values_.resize(left_out_.size());
    for (std::size_t f = 0; f < known_.size(); ++f) {
      const auto value = known_[f].value;
      for (std::size_t b = 0; b < values_.size(); ++b) {
        values_[b] = left_out_[b].*value;
        if (value == &MapValues::axis_angle_deg) values_[b] = nearest_turn(values_[b] - whole.*value, 180);
      }
      rows_.fields[f].ci99[at] = jackknife_ci99(values_);
    }
  }

  const MapBatches& batches_;
  double container_radius_;
  MapShare total_;
  std::vector<MapShare> shares_;  // without one batch each
  std::vector<NamedMapField> known_;
  DisplacementFields motion_;
  std::vector<MapValues> left_out_;
  TileOfBatches tile_;
  MapRows rows_;
  std::vector<double> values_;
};

}  // namespace

MapGrid map_grid(const MapBatches& batches, double surface_z) {
  MapGrid grid = batches.graining().grid;
  grid.z_first -= surface_z;
  grid.rows = batches.rows_reached();
  return grid;
}

void each_map_rows(const MapBatches& batches, double container_radius,
                   const std::function<void(const MapRows&)>& action) {
  RowMaker maker(batches, container_radius);
  const std::size_t rows = batches.rows_reached();
  for (std::size_t tile_row = 0; tile_row < NodeTiles<MapNode>::tiles_along(rows); ++tile_row)
    action(maker.rows(tile_row, rows));
}

}  // namespace drumlin::particles
