#include "particles/measurement/layers/layer_grid.hpp"

#include <limits>
#include <numbers>

namespace drumlin::particles {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

Rectangle LayerGrid::rectangle(std::size_t layer) const {
  const double bottom = z_min + static_cast<double>(layer) * thickness;
  return Rectangle{x_min, x_max, bottom, bottom + thickness};
}

std::size_t LayerGrid::layer_at(double z) const {
  const double place = std::floor((z - z_min) / thickness), count = static_cast<double>(layers());
  if (closed) return static_cast<std::size_t>(std::clamp(place, 0.0, count - 1));
  return place >= 0 && place < count ? static_cast<std::size_t>(place) : layers();
}

LayerGrid LayerGrid::in_cell(const FlowSnapshot& snapshot) const {
  LayerGrid grid = *this;
  if (!closed) return grid;
  grid.z_min = snapshot.cell.origin_z;
  grid.thickness = snapshot.cell.length_z / static_cast<double>(layers());
  return grid;
}

LayerGrid closed_grid(const FlowFrame& frame, double thickness, double z_from, double z_to, double period) {
  const double layers = std::max(1.0, std::round((z_to - z_from) / thickness));
  LayerGrid grid{frame, -infinity, infinity, z_from, (z_to - z_from) / layers, {}, true};
  grid.area.assign(static_cast<std::size_t>(layers), period * grid.thickness);
  return grid;
}

LayerGrid layer_grid(const FlowFrame& frame, double position, double slice_width, double thickness,
                     double z_from, double z_to, double container_radius, double period) {
  LayerGrid grid{frame, position - slice_width / 2, position + slice_width / 2, 0, thickness, {}};
  if (period > 0) {
    grid.x_min = -infinity;
    grid.x_max = infinity;
  }
  const double first = std::floor(z_from / thickness), end = std::ceil(z_to / thickness);
  grid.z_min = first * thickness;
  grid.area.assign(static_cast<std::size_t>(std::max(0.0, end - first)),
                   (period > 0 ? period : slice_width) * thickness);
  if (container_radius > 0)
    for (std::size_t l = 0; l < grid.layers(); ++l)
      grid.area[l] = disc_area_in(0, 0, container_radius, grid.rectangle(l));
  return grid;
}

double disc_area_in_circle(double distance, double radius, double circle) {
  if (distance >= radius + circle) return 0;
  const double smaller = std::min(radius, circle);
  if (distance <= std::abs(radius - circle)) return std::numbers::pi * smaller * smaller;
  const auto angle = [&](double own, double other) {
    return std::acos(
        std::clamp((distance * distance + own * own - other * other) / (2 * distance * own), -1.0, 1.0));
  };
  const auto segment = [](double own, double half_angle) {
    return own * own * (half_angle - std::sin(half_angle) * std::cos(half_angle));
  };
  return segment(radius, angle(radius, circle)) + segment(circle, angle(circle, radius));
}

LayerGrid ring_grid(double centre_x, double centre_z, double thickness, double r_to,
                    double container_radius) {
  LayerGrid grid{FlowFrame{centre_x, centre_z, 1, 0}, 0, 0, 0, thickness, {}, false, true};
  const double reach = container_radius > 0 ? std::min(r_to, container_radius) : r_to;
  for (double inner = 0; inner < reach; inner += thickness) {
    const double outer =
        container_radius > 0 ? std::min(inner + thickness, container_radius) : inner + thickness;
    grid.area.push_back(std::numbers::pi * (outer * outer - inner * inner));
  }
  return grid;
}

std::vector<double> RingBinning::cuts_of(double x, double z, double toward_x, double toward_z) const {
  std::vector<double> cuts{0, 1};
  // |p + s t|^2 = R^2 at the boundaries R between the least and the greatest distance.
  const double a = toward_x * toward_x + toward_z * toward_z;
  const double half = x * toward_x + z * toward_z, c = x * x + z * z;
  if (!(a > 0)) return cuts;
  const double nearest = std::clamp(-half / a, 0.0, 1.0);
  const auto distance = [&](double s) { return std::sqrt(std::max(0.0, c + s * (2 * half + s * a))); };
  const double greatest = std::max(distance(0), distance(1));
  for (double ring = std::ceil(distance(nearest) / grid_.thickness); ring * grid_.thickness < greatest;
       ++ring) {
    const double R = ring * grid_.thickness, root = half * half - a * (c - R * R);
    if (!(root > 0)) continue;
    for (const double sign : {-1.0, 1.0})
      if (const double s = (-half + sign * std::sqrt(root)) / a; s > 0 && s < 1) cuts.push_back(s);
  }
  std::sort(cuts.begin(), cuts.end());
  return cuts;
}

}  // namespace drumlin::particles
