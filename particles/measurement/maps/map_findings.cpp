#include "particles/measurement/maps/map_findings.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "coupling/statistics/straight_line.hpp"
#include "particles/measurement/frame/intervals.hpp"

namespace drumlin::particles {
namespace {

double wall_distance(const MapBounds& bounds, double x, double z) {
  if (bounds.container_radius > 0) return bounds.container_radius - std::hypot(x, z - bounds.axis_z);
  return std::min({z - bounds.z_min, x - bounds.x_min, bounds.x_max - x});
}

double surface_between(const MapGrid& grid, std::size_t row, double nu, double nu_above, double surface_nu) {
  if (row + 1 == grid.rows) return grid.z_of(row);
  return grid.z_of(row) + grid.spacing_z * (nu - surface_nu) / (nu - nu_above);
}

/// Highest z of a column where nu crosses `surface_nu`, linear between nodes; minus infinity when it never
/// does.
double surface_z(const FieldMap& map, const std::vector<double>& nu, std::size_t column, double surface_nu) {
  const MapGrid& grid = map.grid;
  const auto at = [&](std::size_t row) {
    const double value = nu[row * grid.columns + column];
    return std::isnan(value) ? 0 : value;
  };
  for (std::size_t row = grid.rows; row-- > 0;) {
    if (at(row) < surface_nu) continue;
    return surface_between(grid, row, at(row), row + 1 == grid.rows ? 0 : at(row + 1), surface_nu);
  }
  return -std::numeric_limits<double>::infinity();
}

double root_mean_square(const std::vector<double>& values, const std::vector<std::size_t>& nodes) {
  double squares = 0, count = 0;
  for (std::size_t node : nodes) {
    if (!std::isfinite(values[node])) continue;
    squares += values[node] * values[node];
    count += 1;
  }
  return count > 0 ? std::sqrt(squares / count) : std::numeric_limits<double>::quiet_NaN();
}

double mean(const std::vector<double>& values, const std::vector<std::size_t>& nodes) {
  double sum = 0;
  for (std::size_t node : nodes) sum += values[node];
  return sum / static_cast<double>(nodes.size());
}

/// Root mean square of a field's standard errors; NaN without intervals.
double noise_of(const MapField& field, const std::vector<std::size_t>& nodes, std::size_t batches) {
  return field.ci99.empty() || batches < 2 ? std::numeric_limits<double>::quiet_NaN()
                                           : root_mean_square(field.ci99, nodes) / interval_factor(batches);
}

/// Root mean square of the means over squares of side `side`.
double rms_of_blocks(const FieldMap& map, const std::vector<double>& values,
                     const std::vector<std::size_t>& nodes, double side) {
  struct Block {
    double sum = 0, count = 0;
  };
  const MapGrid& grid = map.grid;
  std::map<std::pair<double, double>, Block> blocks;
  for (std::size_t node : nodes) {
    Block& block = blocks[{std::floor(grid.x_of(node % grid.columns) / side),
                           std::floor(grid.z_of(node / grid.columns) / side)}];
    block.sum += values[node];
    block.count += 1;
  }
  const double whole = side * side / (grid.spacing_x * grid.spacing_z);
  double squares = 0, count = 0;
  for (const auto& [place, block] : blocks) {
    if (block.count < 0.75 * whole) continue;
    squares += std::pow(block.sum / block.count, 2);
    count += 1;
  }
  return count > 0 ? std::sqrt(squares / count) : std::numeric_limits<double>::quiet_NaN();
}

BalanceResidual residual_over(const FieldMap& map, const std::vector<std::size_t>& nodes, double block,
                              std::size_t batches) {
  const MapField &x = map.field("residual_x"), &z = map.field("residual_z");
  return {nodes.size(),
          root_mean_square(x.value, nodes),
          root_mean_square(z.value, nodes),
          mean(x.value, nodes),
          mean(z.value, nodes),
          noise_of(x, nodes, batches),
          noise_of(z, nodes, batches),
          rms_of_blocks(map, x.value, nodes, block),
          rms_of_blocks(map, z.value, nodes, block),
          root_mean_square(map.field("residual_x_without_kinetic").value, nodes),
          root_mean_square(map.field("residual_z_without_kinetic").value, nodes),
          std::hypot(root_mean_square(map.field("inertia_x").value, nodes),
                     root_mean_square(map.field("inertia_z").value, nodes))};
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

std::span<const FindingField> fields_of_findings() {
  static constexpr FindingField fields[] = {{"nu", false},
                                            {"p", false},
                                            {"I", false},
                                            {"mu", true},
                                            {"d_v_x_dz", false},
                                            {"sigma_xz", false},
                                            {"sigma_zz", false},
                                            {"residual_x", true},
                                            {"residual_z", true},
                                            {"residual_x_without_kinetic", false},
                                            {"residual_z_without_kinetic", false},
                                            {"inertia_x", false},
                                            {"inertia_z", false}};
  return fields;
}

std::vector<std::size_t> bulk_nodes(const FieldMap& map, const MapBounds& bounds,
                                    const MapFindingOptions& options) {
  const auto& nu = map.field("nu").value;
  const auto& p = map.field("p").value;
  std::vector<std::size_t> nodes;
  std::vector<double> surface(map.grid.columns);
  for (std::size_t column = 0; column < surface.size(); ++column)
    surface[column] = surface_z(map, nu, column, options.surface_nu);
  for (std::size_t node = 0; node < map.grid.nodes(); ++node) {
    const std::size_t column = node % map.grid.columns;
    const double x = map.grid.x_of(column), z = map.grid.z_of(node / map.grid.columns);
    if (std::isfinite(p[node]) && surface[column] - z > options.margin &&
        wall_distance(bounds, x, z) > options.margin)
      nodes.push_back(node);
  }
  return nodes;
}

MomentumBalance momentum_balance(const FieldMap& map, const MapBounds& bounds,
                                 const MapFindingOptions& options, std::size_t batches) {
  const auto& I = map.field("I").value;
  const auto bulk = bulk_nodes(map, bounds, options);
  std::vector<std::size_t> flowing, slow;
  for (std::size_t node : bulk) (I[node] >= options.flowing_I ? flowing : slow).push_back(node);
  const auto over = [&](const std::vector<std::size_t>& nodes) {
    return residual_over(map, nodes, options.block, batches);
  };
  return {over(bulk), over(flowing), over(slow)};
}

BulkFriction bulk_friction(const FieldMap& map, const MapBounds& bounds, const MapFindingOptions& options,
                           std::size_t batches) {
  const auto &I = map.field("I").value, &mu = map.field("mu").value;
  const auto &rate = map.field("d_v_x_dz").value, &sigma_xz = map.field("sigma_xz").value,
             &sigma_zz = map.field("sigma_zz").value;
  const auto in_range = [&](double value) { return value >= options.I_min && value <= options.I_max; };
  Points by_invariants, by_ratio;
  std::vector<std::size_t> fitted;
  const auto bulk = bulk_nodes(map, bounds, options);
  for (std::size_t node : bulk) {
    if (in_range(I[node])) {
      fitted.push_back(node);
      by_invariants.log_I.push_back(std::log(I[node]));
      by_invariants.y.push_back(mu[node]);
    }
    const double layer_I = rate[node] / std::sqrt(sigma_zz[node]);
    if (!in_range(layer_I)) continue;
    by_ratio.log_I.push_back(std::log(layer_I));
    by_ratio.y.push_back(sigma_xz[node] / sigma_zz[node]);
  }
  return {line_through(by_invariants), line_through(by_ratio), bulk.size(),
          noise_of(map.field("mu"), fitted, batches)};
}

FrictionLine::FrictionLine(const MapGrid& grid, const MapBounds& bounds, const MapFindingOptions& options,
                           const std::shared_ptr<ScratchFile>& file)
    : grid_(grid), bounds_(bounds), options_(options), tops_(grid.columns), points_(file) {}

void FrictionLine::add(std::size_t node, double nu, double p, double I, double mu) {
  const std::size_t row = node / grid_.columns, column = node % grid_.columns;
  const double known_nu = std::isnan(nu) ? 0 : nu;
  Top& top = tops_[column];
  if (top.row + 1 == row) top.nu_above = known_nu;
  if (known_nu >= options_.surface_nu) top = {row, known_nu, 0};
  if (std::isfinite(p) && I >= options_.I_min && I <= options_.I_max &&
      wall_distance(bounds_, grid_.x_of(column), grid_.z_of(row)) > options_.margin)
    points_.push_back({node, I, mu});
}

double FrictionLine::surface(std::size_t column) const {
  const Top& top = tops_[column];
  if (top.row == Top::none) return -std::numeric_limits<double>::infinity();
  return surface_between(grid_, top.row, top.nu, top.nu_above, options_.surface_nu);
}

LogLine FrictionLine::line() const {
  std::vector<double> surfaces(grid_.columns);
  for (std::size_t column = 0; column < surfaces.size(); ++column) surfaces[column] = surface(column);
  Points points;
  points_.each([&](const Point& point) {
    if (!(surfaces[point.node % grid_.columns] - grid_.z_of(point.node / grid_.columns) > options_.margin))
      return;
    points.log_I.push_back(std::log(point.I));
    points.y.push_back(point.mu);
  });
  return line_through(points);
}

}  // namespace drumlin::particles
