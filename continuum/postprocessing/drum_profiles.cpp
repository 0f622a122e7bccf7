#include "continuum/postprocessing/drum_profiles.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "continuum/postprocessing/gauss_points.hpp"
#include "coupling/core/basics/no_value.hpp"
#include "coupling/core/results/layer_ratios.hpp"
#include "coupling/core/results/profile_scalars.hpp"

namespace drumlin::continuum {
namespace {

Vec2 in_drum_frame(const DrumGeometry& drum, Vec2 point, Vec2 velocity) {
  const Vec2 rigid = rigid_rotation(drum.rotation, drum.axis_offset, point);
  return {velocity.x - rigid.x, velocity.z - rigid.z};
}

struct LayerMeans {
  double weight = 0;
  double v_x = 0, v_z = 0, shear_rate = 0, sigma_xx = 0, sigma_zz = 0, sigma_xz = 0;
};

void add(LayerMeans& layer, const DrumGeometry& drum, Vec2 point, const PointState& state, double weight) {
  if (!std::isfinite(state.pressure)) return;  // below the wall, or above a surface that bends
  const Vec2 v = in_drum_frame(drum, point, state.velocity);
  layer.weight += weight;
  layer.v_x += weight * v.x;
  layer.v_z += weight * v.z;
  layer.shear_rate += weight * (state.dvx_dz - drum.rotation);
  layer.sigma_xx += weight * state.sigma_xx;
  layer.sigma_zz += weight * state.sigma_zz;
  layer.sigma_xz += weight * state.sigma_xz;
}

}  // namespace

double slice_width(const SliceOptions& slice, const DrumGeometry& drum) {
  return std::min(slice.width, 0.5 * drum.half_chord());
}

double middle_height(const FlowField& field) { return field.surface() ? height(*field.surface(), 0) : 0; }

ProfileSet drum_profiles(const FlowField& field, const DrumGeometry& drum, const SliceOptions& slice) {
  const double width = slice_width(slice, drum);
  const double top = middle_height(field);
  const int layers =
      static_cast<int>(std::ceil((drum.radius - drum.axis_offset + top) / slice.layer_thickness));
  const int across = std::max(4, static_cast<int>(std::ceil(width)));
  std::vector<Vec2> points;
  for (int layer = layers - 1; layer >= 0; --layer)
    for (const GaussPoint& g : gauss)
      for (int i = 0; i < across; ++i)
        points.push_back(
            {width * ((i + 0.5) / across - 0.5), top - (layer + g.place) * slice.layer_thickness});
  const auto states = field.at(points);

  ProfileSet set;
  std::vector<LayerMeans> means(layers);
  std::size_t k = 0;
  for (int row = 0; row < layers; ++row) {
    set.z.push_back(-(layers - 1 - row + 0.5) * slice.layer_thickness);
    for (const GaussPoint& g : gauss)
      for (int i = 0; i < across; ++i, ++k) add(means[row], drum, points[k], states[k], g.weight / across);
  }
  const auto column = [&](const std::string& name, auto&& value) {
    ProfileColumn result{name, {}, {}};
    for (const LayerMeans& m : means) result.value.push_back(m.weight > 0 ? value(m) : no_value);
    set.columns.push_back(std::move(result));
  };
  column("v_x", [](const LayerMeans& m) { return m.v_x / m.weight; });
  column("v_z", [](const LayerMeans& m) { return m.v_z / m.weight; });
  column("shear_rate", [](const LayerMeans& m) { return m.shear_rate / m.weight; });
  column("nu", [&](const LayerMeans&) { return drum.nu; });
  column("sigma_xx", [](const LayerMeans& m) { return m.sigma_xx / m.weight; });
  column("sigma_zz", [](const LayerMeans& m) { return m.sigma_zz / m.weight; });
  column("sigma_xz", [](const LayerMeans& m) { return m.sigma_xz / m.weight; });
  add_layer_ratios(set);
  return set;
}

double discharge(const FlowField& field, const DrumGeometry& drum) {
  const double top = middle_height(field), depth = drum.radius - drum.axis_offset + top;
  const int pieces = std::max(64, static_cast<int>(std::ceil(4 * depth)));
  std::vector<Vec2> points;
  for (int i = 0; i < pieces; ++i)
    for (const GaussPoint& g : gauss) points.push_back({0, top - depth * (i + g.place) / pieces});
  const auto states = field.at(points);
  double sum = 0;
  for (std::size_t k = 0; k < points.size(); ++k)
    if (std::isfinite(states[k].pressure))
      sum += drum.nu * in_drum_frame(drum, points[k], states[k].velocity).x * gauss[k % gauss.size()].weight *
             depth / pieces;
  return sum;
}

double flux_imbalance(const FlowField& field, const DrumGeometry& drum, int cuts) {
  std::vector<Vec2> points, steps;  // along each cut, piece by piece
  const auto placed = [&](Vec2 p) { return field.surface() ? displaced(*field.surface(), p) : p; };
  const int pieces = std::max(64, static_cast<int>(std::ceil(4 * drum.radius)));
  const double c = drum.axis_offset;
  for (int i = 0; i < cuts; ++i) {
    const double angle = std::numbers::pi * ((i + 0.5) / cuts - 0.5);  // from the vertical
    const Vec2 along{std::sin(angle), -std::cos(angle)};
    // |s along - (0, c)| = R.
    const double length = c * along.z + std::sqrt(drum.radius * drum.radius - c * c * along.x * along.x);
    const auto at = [&](double s) { return placed({s * along.x, s * along.z}); };
    for (int k = 0; k < pieces; ++k) {
      const double h = length / pieces;
      for (const GaussPoint& g : gauss) {
        const Vec2 before = at(h * (k + g.place - 1e-4)), after = at(h * (k + g.place + 1e-4));
        points.push_back(at(h * (k + g.place)));
        steps.push_back({(after.x - before.x) / 2e-4, (after.z - before.z) / 2e-4});
      }
    }
  }
  const auto states = field.at(points);
  double largest = 0;
  std::size_t k = 0;
  for (int cut = 0; cut < cuts; ++cut) {
    double net = 0;
    for (int point = 0; point < pieces * static_cast<int>(gauss.size()); ++point, ++k) {
      if (!std::isfinite(states[k].pressure)) continue;  // between the wall and its quadratic arc
      const Vec2 u = states[k].velocity;
      net += (-u.x * steps[k].z + u.z * steps[k].x) * gauss[k % gauss.size()].weight;
    }
    largest = std::max(largest, std::abs(net));
  }
  return drum.nu * largest / drum.expected_Q(middle_height(field));
}

ScalarSet drum_scalars(const FlowField& field, const DrumGeometry& drum, const ProfileSet& profiles) {
  const ProfileScalars read = profile_scalars(profiles);
  return {{{"theta_deg", field.theta() * 180 / std::numbers::pi, {}},
           {"Q", discharge(field, drum), {}},
           {"H", read.H, {}},
           {"lambda", read.lambda, {}},
           {"shear_rate", read.shear_rate, {}},
           {"I_th", read.I_th, {}}}};
}

ScalarSet drum_checks(const FlowField& field, const DrumGeometry& drum) {
  const FlowIntegrals sums = field.integrals({0, drum.axis_offset});
  const double supplied = sums.given_side_power + sums.weight_power;
  // About the axis, sigma_nn at x turns as x sigma_nn: the moment of the surface, which a slope that was
  // given leaves.
  const double carried = sums.given_side_torque + sums.surface_moment;
  const double expected = drum.expected_Q(middle_height(field));
  return {{{"Q_expected", expected, {}},
           {"Q_relative_error", discharge(field, drum) / expected - 1, {}},
           {"flux_imbalance", flux_imbalance(field, drum), {}},
           {"surface_leak", sums.surface_leak, {}},
           {"dissipation", sums.dissipation, {}},
           {"wall_power", sums.given_side_power, {}},
           {"weight_power", sums.weight_power, {}},
           {"power_relative_error", sums.dissipation / supplied - 1, {}},
           {"wall_torque", sums.given_side_torque, {}},
           {"weight_torque", sums.weight_torque, {}},
           {"torque_relative_error", carried / -sums.weight_torque - 1, {}},
           {"surface_force", sums.surface_force, {}},
           {"surface_moment", sums.surface_moment, {}}}};
}

MapArea drum_map_area(const FlowField& field, const DrumGeometry& drum) {
  const double middle = middle_height(field), axis = drum.axis_offset - middle;
  RunHeader header;
  header.drum_radius = drum.radius;
  header.axis_depth = axis;
  return {.x_min = -drum.radius,
          .x_max = drum.radius,
          .z_min = axis - drum.radius,
          .z_max = field.surface() ? highest_point(*field.surface()) - middle : 0,
          .z_zero = middle,
          .inside = [drum, axis](Vec2 p) { return std::hypot(p.x, p.z - axis) < drum.radius; },
          .nu = drum.nu,
          .frame = RotatingFrame{drum.rotation, axis},
          .header = header};
}

}  // namespace drumlin::continuum
