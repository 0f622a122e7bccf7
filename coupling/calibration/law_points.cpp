#include "coupling/calibration/law_points.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string>
#include <utility>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/statistics/quantiles.hpp"

namespace drumlin::coupling {
namespace {

// Mean over the nodes of a block and the standard error of it.
struct Mean {
  double value = 0;
  double variance = 0;
};

class Block {
 public:
  Block(const FieldMap& map, std::size_t row, std::vector<std::size_t> columns)
      : map_(map),
        row_(row),
        columns_(std::move(columns)),
        factor_(map.header.interval_factor.value_or(statistics::normal_quantile_99)) {}

  // Whether the map has this field, with numbers at every node of the block.
  bool knows(const std::string& name) const {
    const MapField* field = map_.find(name);
    return field != nullptr && std::all_of(columns_.begin(), columns_.end(), [&](std::size_t column) {
             return std::isfinite(field->value[row_ * map_.grid.columns + column]);
           });
  }

  Mean of(const std::string& name) const {
    const MapField& field = map_.field(name);
    const auto count = static_cast<double>(columns_.size());
    Mean mean;
    for (const std::size_t column : columns_) {
      const std::size_t node = row_ * map_.grid.columns + column;
      mean.value += field.value[node] / count;
      if (field.ci99.empty()) continue;
      const double error = field.ci99[node] / factor_;
      // Two neighbours share so much of their kernels that they count as one.
      mean.variance += 2 * error * error / (count * count);
    }
    return mean;
  }

 private:
  const FieldMap& map_;
  std::size_t row_;
  std::vector<std::size_t> columns_;
  double factor_;  // half widths of the map's 99 % intervals per standard error
};

// Half of a difference or of a sum.
Mean half(const Mean& a, const Mean& b, double sign) {
  return {0.5 * (a.value + sign * b.value), 0.25 * (a.variance + b.variance)};
}

// A traceless symmetric tensor has two components, ((a, b), (b, -a)).
struct Traceless {
  Mean a, b;
};

LawBlock point_of(const Block& block, double x, double z, const BlockSelection& selection, bool& usable) {
  const bool moved = selection.displacements && block.knows("displacement_d_v_x_dx");
  const auto gradient = [&](const char* name) {
    return block.of(moved ? std::string("displacement_") + name : std::string(name));
  };
  const Mean stretch_x = gradient("d_v_x_dx"), stretch_z = gradient("d_v_z_dz");
  const Traceless D{half(stretch_x, stretch_z, -1), half(gradient("d_v_x_dz"), gradient("d_v_z_dx"), 1)};
  const Mean xx = block.of("sigma_xx"), zz = block.of("sigma_zz");
  const Mean p = half(xx, zz, 1), difference = half(xx, zz, -1),
             shear = half(block.of("sigma_xz"), block.of("sigma_zx"), 1);
  const double variance = D.a.variance + D.b.variance;
  const double squared = D.a.value * D.a.value + D.b.value * D.b.value - variance;
  LawBlock point;
  point.x = x;
  point.z = z;
  usable = p.value > 0 && squared > 0 && squared >= std::pow(selection.least_signal, 2) * variance;
  if (!usable) return point;
  const double rate = std::sqrt(squared);
  // tau is traction-positive: its components are -difference and shear.
  const double along = (-difference.value * D.a.value + shear.value * D.b.value) / rate;
  const double across = (difference.value * D.b.value + shear.value * D.a.value) / rate;
  const double stress_variance = 0.5 * (difference.variance + shear.variance);
  const auto error = [&](double stress, double other) {
    const double relative = p.variance / (p.value * p.value);
    const double axes = 0.5 * variance / squared;  // the axes of a noisy D are turned
    return std::sqrt(stress_variance + stress * stress * relative + other * other * axes) / p.value;
  };
  point.p = p.value;
  point.strain_rate = 2 * rate;
  point.friction.I = 2 * rate / std::sqrt(p.value);
  point.friction.mu = along / p.value;
  point.friction.mu_error = error(along, across);
  point.friction.I_error = point.friction.I * std::sqrt(0.5 * variance / squared);
  point.turn = across / p.value;
  point.turn_error = error(across, along);
  const double s_squared = difference.value * difference.value + shear.value * shear.value;
  const double deviator_squared = s_squared - difference.variance - shear.variance;
  point.stress_ratio = std::sqrt(std::max(deviator_squared, 0.0)) / p.value;
  point.stress_ratio_error = error(point.stress_ratio * p.value, 0);
  point.dilatancy = (stretch_x.value + stretch_z.value) / (2 * rate);
  usable = point.friction.I >= selection.I_min && point.friction.I <= selection.I_max;
  return point;
}

}  // namespace

std::vector<LawBlock> law_points(const FieldMap& map, const BlockSelection& selection) {
  const MapGrid& grid = map.grid;
  const double radius = needed_number(map.header, &RunHeader::drum_radius, "maps.h5");
  const double axis = needed_number(map.header, &RunHeader::axis_depth, "maps.h5");
  const MapField& nu = map.field("nu");
  const MapField& stress = map.field("sigma_zz");
  const MapField& gradient = map.field("d_v_x_dz");
  // Highest row of each column that is packed.
  std::vector<double> surface(grid.columns, grid.z_first - 1);
  for (std::size_t column = 0; column < grid.columns; ++column)
    for (std::size_t row = 0; row < grid.rows; ++row)
      if (nu.value[row * grid.columns + column] >= selection.least_nu) surface[column] = grid.z_of(row);
  const auto inside = [&](std::size_t column, std::size_t row) {
    const double x = grid.x_of(column), z = grid.z_of(row);
    const std::size_t node = row * grid.columns + column;
    return z <= std::min(0.0, surface[column]) - selection.surface_margin &&
           (radius <= 0 || std::hypot(x, z - axis) <= radius - selection.wall_margin) &&
           nu.value[node] >= selection.least_nu && std::isfinite(stress.value[node]) &&
           std::isfinite(gradient.value[node]);
  };

  const double right = grid.x_of(grid.columns - 1);
  const auto halves = static_cast<int>(std::ceil(right / selection.width));
  std::vector<LawBlock> points;
  for (int b = -halves; b <= halves; ++b) {
    const double from = (b - 0.5) * selection.width;
    for (std::size_t row = 0; row < grid.rows; ++row) {
      std::vector<std::size_t> columns;
      std::size_t all = 0;
      for (std::size_t column = 0; column < grid.columns; ++column) {
        const double x = grid.x_of(column);
        if (x < from || x >= from + selection.width) continue;
        ++all;
        if (inside(column, row)) columns.push_back(column);
      }
      if (columns.empty() || 10 * columns.size() < 7 * all) continue;
      bool usable = false;
      const LawBlock point = point_of(Block(map, row, std::move(columns)), from + selection.width / 2,
                                      grid.z_of(row), selection, usable);
      if (usable) points.push_back(point);
    }
  }
  return points;
}

std::vector<FrictionPoint> frictions(const std::vector<LawBlock>& points) {
  std::vector<FrictionPoint> result;
  for (const LawBlock& point : points) result.push_back(point.friction);
  return result;
}

std::vector<FrictionPoint> turns(const std::vector<LawBlock>& points) {
  std::vector<FrictionPoint> result;
  for (const LawBlock& point : points)
    result.push_back({point.friction.I, point.turn, point.friction.I_error, point.turn_error});
  return result;
}

std::vector<FrictionPoint> stress_ratios(const std::vector<LawBlock>& points) {
  std::vector<FrictionPoint> result;
  for (const LawBlock& point : points)
    result.push_back(
        {point.friction.I, point.stress_ratio, point.friction.I_error, point.stress_ratio_error});
  return result;
}

std::vector<FrictionPoint> frictions_with_k(const std::vector<LawBlock>& points, const StressRatioLaw& k) {
  std::vector<FrictionPoint> result = frictions(points);
  for (FrictionPoint& point : result) {
    const ShearState at = shear_state(k, 0.5 * point.I, 1);
    const double half_sum = 0.5 * (1 + at.k);
    point.mu *= half_sum;
    point.mu_error *= half_sum;
    point.I_error *= at.I / point.I;
    point.I = at.I;
  }
  return result;
}

double turn_angle_deg(double turn, double friction) {
  return std::atan2(turn, friction) * 90 / std::numbers::pi;
}

}  // namespace drumlin::coupling
