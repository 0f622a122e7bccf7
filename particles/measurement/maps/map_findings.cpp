#include "particles/measurement/maps/map_findings.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "coupling/core/results/layer_ratios.hpp"
#include "coupling/core/statistics/straight_line.hpp"
#include "particles/measurement/frame/intervals.hpp"

namespace drumlin::particles {
namespace {

double wall_distance(const MapBounds& bounds, double x, double z) {
  if (bounds.container_radius > 0) return bounds.container_radius - std::hypot(x, z - bounds.axis_z);
  return std::min({z - bounds.z_min, x - bounds.x_min, bounds.x_max - x});
}

using Nodes = std::vector<std::size_t>;
using Value = double FindingNode::*;

double root_mean_square(const FindingMap& map, Value value, const Nodes& nodes) {
  double squares = 0, count = 0;
  for (std::size_t node : nodes) {
    const double here = map.nodes[node].*value;
    if (!std::isfinite(here)) continue;
    squares += here * here;
    count += 1;
  }
  return count > 0 ? std::sqrt(squares / count) : FindingNode::none;
}

double mean(const FindingMap& map, Value value, const Nodes& nodes) {
  double sum = 0;
  for (std::size_t node : nodes) sum += map.nodes[node].*value;
  return sum / static_cast<double>(nodes.size());
}

/// Root mean square of standard errors; NaN without intervals.
double noise_of(const FindingMap& map, Value ci99, const Nodes& nodes, std::size_t batches) {
  return batches < 2 ? FindingNode::none : root_mean_square(map, ci99, nodes) / interval_factor(batches);
}

/// Root mean square of the means over squares of side `side`.
double rms_of_blocks(const FindingMap& map, Value value, const Nodes& nodes, double side) {
  const MapGrid& grid = map.grid;
  std::map<std::pair<double, double>, SeriesSum> blocks;
  for (std::size_t node : nodes) {
    const std::pair place(std::floor(grid.x_of(node % grid.columns) / side),
                          std::floor(grid.z_of(node / grid.columns) / side));
    add_times(1, SeriesSum{map.nodes[node].*value, 1}, blocks[place]);
  }
  const double whole = side * side / (grid.spacing_x * grid.spacing_z);
  double squares = 0, count = 0;
  for (const auto& [place, block] : blocks) {
    if (block.count < 0.75 * whole) continue;
    squares += std::pow(block.mean(), 2);
    count += 1;
  }
  return count > 0 ? std::sqrt(squares / count) : std::numeric_limits<double>::quiet_NaN();
}

BalanceResidual residual_over(const FindingMap& map, const Nodes& nodes, double block, std::size_t batches) {
  using Of = FindingNode;
  const auto rms = [&](Value value) { return root_mean_square(map, value, nodes); };
  return {nodes.size(),
          rms(&Of::residual_x),
          rms(&Of::residual_z),
          mean(map, &Of::residual_x, nodes),
          mean(map, &Of::residual_z, nodes),
          noise_of(map, &Of::residual_x_ci99, nodes, batches),
          noise_of(map, &Of::residual_z_ci99, nodes, batches),
          rms_of_blocks(map, &Of::residual_x, nodes, block),
          rms_of_blocks(map, &Of::residual_z, nodes, block),
          rms(&Of::residual_x_contact),
          rms(&Of::residual_z_contact),
          std::hypot(rms(&Of::inertia_x), rms(&Of::inertia_z))};
}

struct Points {
  std::vector<double> log_I, y;
};

LogLine line_through(const Points& points) {
  LogLine line;
  line.nodes = points.y.size();
  if (line.nodes < 3) return line;
  if (const auto fit = statistics::fit_line(points.log_I, points.y)) {
    line.a = fit->intercept;
    line.b = fit->slope;
    line.rms = std::sqrt(fit->chi_squared / static_cast<double>(line.nodes));
  }
  return line;
}

}  // namespace

Nodes bulk_nodes(const FindingMap& map, const MapBounds& bounds, const MapFindingOptions& options) {
  Nodes nodes;
  std::vector<double> nu;
  for (const FindingNode& node : map.nodes) nu.push_back(node.nu);
  const std::vector<double> surface = surface_heights(map.grid, nu, options.surface_nu);
  for (std::size_t node = 0; node < map.nodes.size(); ++node) {
    const std::size_t column = node % map.grid.columns;
    const double x = map.grid.x_of(column), z = map.grid.z_of(node / map.grid.columns);
    if (std::isfinite(map.nodes[node].p) && surface[column] - z > options.margin &&
        wall_distance(bounds, x, z) > options.margin)
      nodes.push_back(node);
  }
  return nodes;
}

MomentumBalance momentum_balance(const FindingMap& map, const MapBounds& bounds,
                                 const MapFindingOptions& options, std::size_t batches) {
  const Nodes bulk = bulk_nodes(map, bounds, options);
  Nodes flowing, slow;
  for (std::size_t node : bulk) (map.nodes[node].I >= options.flowing_I ? flowing : slow).push_back(node);
  const auto over = [&](const Nodes& nodes) { return residual_over(map, nodes, options.block, batches); };
  return {over(bulk), over(flowing), over(slow)};
}

BulkFriction bulk_friction(const FindingMap& map, const MapBounds& bounds, const MapFindingOptions& options,
                           std::size_t batches) {
  const auto in_range = [&](double value) { return value >= options.I_min && value <= options.I_max; };
  Points by_invariants, by_ratio;
  Nodes fitted;
  const Nodes bulk = bulk_nodes(map, bounds, options);
  for (std::size_t node : bulk) {
    const FindingNode& at = map.nodes[node];
    if (in_range(at.I)) {
      fitted.push_back(node);
      by_invariants.log_I.push_back(std::log(at.I));
      by_invariants.y.push_back(at.mu);
    }
    const LayerRatios layer = layer_ratios({0, at.sigma_zz, at.sigma_xz}, at.d_v_x_dz);
    if (!in_range(layer.I)) continue;
    by_ratio.log_I.push_back(std::log(layer.I));
    by_ratio.y.push_back(layer.mu);
  }
  return {line_through(by_invariants), line_through(by_ratio), bulk.size(),
          noise_of(map, &FindingNode::mu_ci99, fitted, batches)};
}

}  // namespace drumlin::particles
