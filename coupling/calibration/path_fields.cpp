#include "coupling/calibration/path_fields.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "coupling/core/basics/errors.hpp"

namespace drumlin::coupling {
namespace {

constexpr double half_a_grain = 0.5;

/// Weights of a Gaussian over a line of nodes, cut at four standard deviations.
std::vector<double> gaussian(double deviation, double spacing) {
  const auto reach = static_cast<std::size_t>(std::ceil(4 * deviation / spacing));
  std::vector<double> weights;
  for (std::size_t k = 0; k <= reach; ++k)
    weights.push_back(std::exp(-0.5 * std::pow(static_cast<double>(k) * spacing / deviation, 2)));
  return weights;
}

/// One pass of a filter along rows (`stride` 1, `count` columns) or columns.
void filter_lines(std::vector<double>& values, const std::vector<double>& weights, std::size_t lines,
                  std::size_t line_stride, std::size_t count, std::size_t stride) {
  std::vector<double> line(count);
  for (std::size_t l = 0; l < lines; ++l) {
    double* first = values.data() + l * line_stride;
    for (std::size_t i = 0; i < count; ++i) {
      double sum = weights[0] * first[i * stride];
      for (std::size_t k = 1; k < weights.size(); ++k) {
        if (i >= k) sum += weights[k] * first[(i - k) * stride];
        if (i + k < count) sum += weights[k] * first[(i + k) * stride];
      }
      line[i] = sum;
    }
    for (std::size_t i = 0; i < count; ++i) first[i * stride] = line[i];
  }
}

/// Motion from displacements where the map has it, else from the velocities.
std::vector<double> motion(const FieldMap& map, const std::string& name) {
  std::vector<double> values = map.field(name).value;
  const MapField* moved = map.find("displacement_" + name);
  if (moved == nullptr) return values;
  for (std::size_t node = 0; node < values.size(); ++node)
    if (std::isfinite(moved->value[node])) values[node] = moved->value[node];
  return values;
}

}  // namespace

PathFields::PathFields(const FieldMap& map, const PathFieldOptions& options) : grid_(map.grid) {
  axis_ = needed_number(map.header, &RunHeader::axis_depth, "maps.h5");
  radius_ = needed_number(map.header, &RunHeader::drum_radius, "maps.h5");
  rotation_ = needed_number(map.header, &RunHeader::rotation, "maps.h5");
  if (!(radius_ > 0)) throw InputError("maps.h5: has no drum: paths that close need one");
  find_speaking(map, options);
  find_surface(map, options);

  const auto smooth = [&](const std::vector<double>& values) { return smoothed(values, options.smoothing); };
  const auto u = smooth(motion(map, "v_x")), w = smooth(motion(map, "v_z"));
  const auto xx = smooth(motion(map, "d_v_x_dx")), xz = smooth(motion(map, "d_v_x_dz")),
             zx = smooth(motion(map, "d_v_z_dx")), zz = smooth(motion(map, "d_v_z_dz"));
  const auto stress = [&](const char* name) { return smooth(map.field(name).value); };
  const auto s_xx = stress("sigma_xx"), s_zz = stress("sigma_zz"), s_xz = stress("sigma_xz"),
             s_zx = stress("sigma_zx");
  points_.resize(grid_.nodes());
  for (std::size_t node = 0; node < points_.size(); ++node) {
    const double x = grid_.x_of(node % grid_.columns), z = grid_.z_of(node / grid_.columns);
    // The drum turns such that its lowest point moves upslope.
    points_[node] = {u[node] + rotation_ * (z - axis_),
                     w[node] - rotation_ * x,
                     (xz[node] - zx[node]) / 2 + rotation_,
                     (s_xx[node] + s_zz[node]) / 2,
                     {(xx[node] - zz[node]) / 2, (xz[node] + zx[node]) / 2},
                     {(s_zz[node] - s_xx[node]) / 2, (s_xz[node] + s_zx[node]) / 2},
                     xx[node] + zz[node]};
  }
}

void PathFields::find_speaking(const FieldMap& map, const PathFieldOptions& options) {
  const MapField& nu = map.field("nu");
  const std::vector<double> gradient = motion(map, "d_v_x_dz");
  const MapField& stress = map.field("sigma_zz");
  const MapField* moved = map.find("displacement_d_v_x_dz");
  speaks_.assign(grid_.nodes(), false);
  weight_.assign(grid_.nodes(), 0);
  double count = 0, from_displacements = 0;
  for (std::size_t node = 0; node < grid_.nodes(); ++node) {
    const double x = grid_.x_of(node % grid_.columns), z = grid_.z_of(node / grid_.columns);
    speaks_[node] = nu.value[node] >= options.least_nu && std::isfinite(gradient[node]) &&
                    std::isfinite(stress.value[node]) &&
                    std::hypot(x, z - axis_) <= radius_ - options.wall_margin;
    if (!speaks_[node]) continue;
    weight_[node] = nu.value[node];
    count += 1;
    if (moved != nullptr && std::isfinite(moved->value[node])) from_displacements += 1;
  }
  if (count == 0) throw InputError("maps.h5: no node of it lies inside the packing");
  share_ = from_displacements / count;
}

void PathFields::find_surface(const FieldMap& map, const PathFieldOptions& options) {
  const MapField& nu = map.field("nu");
  surface_.assign(grid_.columns, grid_.z_first);
  for (std::size_t column = 0; column < grid_.columns; ++column)
    for (std::size_t row = 0; row < grid_.rows; ++row)
      if (nu.value[row * grid_.columns + column] >= options.least_nu)
        surface_[column] = grid_.z_of(row) - options.surface_clearance;
}

std::vector<double> PathFields::smoothed(const std::vector<double>& values, double deviation) const {
  std::vector<double> sum(values.size(), 0), weight = weight_;
  for (std::size_t node = 0; node < values.size(); ++node)
    if (weight_[node] > 0) sum[node] = weight_[node] * values[node];
  const auto along = gaussian(deviation, grid_.spacing_x), up = gaussian(deviation, grid_.spacing_z);
  for (auto* field : {&sum, &weight}) {
    filter_lines(*field, along, grid_.rows, grid_.columns, grid_.columns, 1);
    filter_lines(*field, up, grid_.columns, 1, grid_.rows, grid_.columns);
  }
  for (std::size_t node = 0; node < values.size(); ++node)
    sum[node] = weight[node] > 1e-6 ? sum[node] / weight[node] : std::numeric_limits<double>::quiet_NaN();
  return sum;
}

double PathFields::surface(double x) const {
  const double place =
      std::clamp((x - grid_.x_first) / grid_.spacing_x, 0.0, static_cast<double>(grid_.columns - 1));
  const auto left = std::min(static_cast<std::size_t>(place), grid_.columns - 2);
  const double share = place - static_cast<double>(left);
  return (1 - share) * surface_[left] + share * surface_[left + 1];
}

void PathFields::bring_inside(double& x, double& z) const {
  z = std::min(z, surface(x));
  const double distance = std::hypot(x, z - axis_), reach = radius_ - half_a_grain;
  if (distance <= reach) return;
  x *= reach / distance;
  z = axis_ + (z - axis_) * reach / distance;
}

PathPoint PathFields::at(double x, double z) const {
  const auto place = [](double value, double first, double spacing, std::size_t count) {
    return std::clamp((value - first) / spacing, 0.0, static_cast<double>(count - 1));
  };
  const double column = place(x, grid_.x_first, grid_.spacing_x, grid_.columns);
  const double row = place(z, grid_.z_first, grid_.spacing_z, grid_.rows);
  const auto left = std::min(static_cast<std::size_t>(column), grid_.columns - 2);
  const auto below = std::min(static_cast<std::size_t>(row), grid_.rows - 2);
  const double a = column - static_cast<double>(left), b = row - static_cast<double>(below);
  PathPoint mean;
  double total = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const PathPoint& point = points_[(below + k / 2) * grid_.columns + left + k % 2];
    const double weight = (k % 2 == 0 ? 1 - a : a) * (k / 2 == 0 ? 1 - b : b);
    if (!(weight > 0) || std::isnan(point.p)) continue;
    total += weight;
    mean.u += weight * point.u;
    mean.w += weight * point.w;
    mean.spin += weight * point.spin;
    mean.p += weight * point.p;
    mean.rate += weight * point.rate;
    mean.stress += weight * point.stress;
    mean.dilation += weight * point.dilation;
  }
  const double scale = total > 0 ? 1 / total : std::numeric_limits<double>::quiet_NaN();
  return {mean.u * scale,    mean.w * scale,      mean.spin * scale,    mean.p * scale,
          mean.rate * scale, mean.stress * scale, mean.dilation * scale};
}

}  // namespace drumlin::coupling
