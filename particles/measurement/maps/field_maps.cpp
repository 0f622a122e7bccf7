#include "particles/measurement/maps/field_maps.hpp"

#include <algorithm>
#include <cmath>

#include "coupling/core/basics/no_value.hpp"
#include "coupling/core/results/plane_invariants.hpp"
#include "coupling/core/results/spline_kernel.hpp"
#include "particles/measurement/frame/intervals.hpp"
#include "particles/measurement/maps/field_values.hpp"

namespace drumlin::particles {
namespace {

/// The makers of rows, with memory that they use again.
class RowMaker {
 public:
  RowMaker(const MapBatches& batches, double container_radius)
      : batches_(batches),
        container_radius_(container_radius),
        snapshots_(batches.snapshots()),
        fields_(known_fields(snapshots_.whole)) {}

  /// Sets the nodes of one row of tiles.
  const MapRows& rows(std::size_t tile_row, std::size_t row_count) {
    const std::size_t columns = grid_.columns;
    rows_.first_row = tile_row * edge;
    rows_.rows = std::min(edge, row_count - rows_.first_row);
    clear(rows_.rows * columns);
    const std::size_t across = NodeTiles<MapNode>::tiles_along(columns);
    for (std::size_t t = 0; t < across; ++t) {
      batches_.read(tile_row * across + t, tile_);
      if (snapshots_.whole.spheres > 0) batches_.read(tile_row * across + t, space_);
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
    rows_.fields.clear();
    for (const MapQuantity& field : fields_)
      rows_.fields.push_back({field.name, std::vector<double>(nodes, no_value),
                              std::vector<double>(snapshots_.without.empty() ? 0 : nodes, no_value)});
    rows_.nodes.assign(nodes, {});
    rows_.without.assign(snapshots_.without.size(), std::vector<FrictionNode>(nodes));
  }

  /// Share of the kernel at a node that lies within the container, 1 without one; 0 for a node outside.
  double share_inside(std::size_t column, std::size_t row) const {
    if (!(container_radius_ > 0)) return 1;
    const double x = grid_.x_of(column), z = grid_.z_of(row);
    if (std::hypot(x, z) > container_radius_) return 0;
    return kernel_share_in_circle(x, z, batches_.graining().width, container_radius_);
  }

  /// What is known at a node, and of its motion by displacements, where these are local.
  struct NodeValues {
    LeaveOneOut<MapValues> seen, displaced;
  };

  /// The sums of one node, of the tiles of all batches.
  template <class Node>
  static LeaveOneOut<Node> node_of(const std::vector<std::vector<Node>>& tile, std::size_t place) {
    std::vector<Node> batches(tile.size());
    for (std::size_t b = 0; b < tile.size(); ++b)
      if (!tile[b].empty()) batches[b] = tile[b][place];
    return leave_one_out(batches);
  }

  NodeValues values_of(std::size_t place, double inside) const {
    const LeaveOneOut<MapNode> sums = node_of(tile_, place);
    NodeValues values;
    values.seen = each_of(
        [&](const MapNode& node, const MapSums::Snapshots& all) { return values_at(node, all, inside); },
        sums, snapshots_);
    if (snapshots_.whole.spheres > 0)
      values.seen = each_of(
          [&](MapValues seen, const SpaceNode& node, const MapSums::Snapshots& all) {
            set_space(node, all, inside, seen);
            return seen;
          },
          values.seen, node_of(space_, place), snapshots_);
    const MapValues& whole = values.seen.whole;
    if (!std::isfinite(whole.v_x)) return values;
    const PlaneMatrix pressure{whole.sigma_xx, -whole.sigma_xz, -whole.sigma_zx, whole.sigma_zz};
    const auto displaced = [&](const MapNode& node) { return displaced_values(node, pressure); };
    const MapValues motion = displaced(sums.whole);
    if (std::hypot(motion.v_x, motion.v_z) * snapshots_.whole.time <=
        longest_displacement * batches_.graining().width * snapshots_.whole.pairs)
      values.displaced = each_of(displaced, sums);
    return values;
  }

  /// `place` within the tile; `row` counts from the first one of the tile.
  void set_node(std::size_t place, std::size_t column, std::size_t row) {
    const double inside = share_inside(column, rows_.first_row + row);
    if (inside == 0) return;
    const std::size_t at = row * grid_.columns + column;
    const auto [values, displaced] = values_of(place, inside);
    const MapValues& whole = values.whole;
    for (std::size_t f = 0; f < fields_.size(); ++f) {
      const MapQuantity& field = fields_[f];
      const auto& of = field.displaced ? displaced : values;
      const double value = rows_.fields[f].value[at] = of.whole.*field.value;
      if (std::isnan(value) || of.without.empty()) continue;
      rows_.fields[f].ci99[at] = ci99_of(of, [&](const MapValues& one) {
        return field.period > 0 ? nearest_turn(one.*field.value - value, field.period) : one.*field.value;
      });
    }
    rows_.nodes[at] = {{whole.nu, whole.p, whole.I, whole.mu},
                       whole.d_v_x_dz,
                       whole.sigma_xz,
                       whole.sigma_zz,
                       whole.residual_x,
                       whole.residual_z,
                       whole.residual_x_contact,
                       whole.residual_z_contact,
                       whole.inertia_x,
                       whole.inertia_z,
                       ci99_of(values, &MapValues::mu),
                       ci99_of(values, &MapValues::residual_x),
                       ci99_of(values, &MapValues::residual_z)};
    for (std::size_t b = 0; b < values.without.size(); ++b) {
      const MapValues& one = values.without[b];
      rows_.without[b][at] = {one.nu, one.p, one.I, one.mu};
    }
  }

  const MapBatches& batches_;
  const MapGrid& grid_ = batches_.graining().grid;
  double container_radius_;
  LeaveOneOut<MapSums::Snapshots> snapshots_;
  std::vector<MapQuantity> fields_;
  std::vector<std::vector<MapNode>> tile_;
  std::vector<std::vector<SpaceNode>> space_;
  MapRows rows_;
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
