#include <algorithm>
#include <cmath>
#include <numbers>

#include "particles/measurement/layers/layer_sums.hpp"

namespace drumlin::particles {
namespace {

constexpr double gauss_offset = 0.28867513459481288;  // sqrt(3)/6 from the middle of a piece of length 1

/// The axes at a place: out from the centre, and clockwise about it. The centre itself counts as above.
struct PolarAxes {
  double r_x = 0, r_z = 1;
  double along_r(double x, double z) const { return x * r_x + z * r_z; }
  double along_t(double x, double z) const { return x * r_z - z * r_x; }
};

PolarAxes axes_at(double x, double z, double r) { return r > 0 ? PolarAxes{x / r, z / r} : PolarAxes{}; }

void add_to_rings(const LayerGrid& grid, const FlowSnapshot& snapshot, std::size_t i,
                  std::vector<LayerSum>& rings) {
  const double x = snapshot.x[i], z = snapshot.z[i], radius = snapshot.radius[i], r = std::hypot(x, z);
  const double density = snapshot.density_of(i);
  const auto count = static_cast<double>(rings.size());
  const double first = std::max(0.0, std::floor((r - radius) / grid.thickness));
  double below = disc_area_in_circle(r, radius, first * grid.thickness);
  for (double ring = first; ring < std::min(count, std::ceil((r + radius) / grid.thickness)); ++ring) {
    const double up_to = disc_area_in_circle(r, radius, (ring + 1) * grid.thickness);
    LayerSum& sum = rings[static_cast<std::size_t>(ring)];
    sum.covered += up_to - below;
    sum.covered_mass += density * (up_to - below);
    below = up_to;
  }
  const double place = std::floor(r / grid.thickness);
  if (!(place < count)) return;
  const auto index = static_cast<std::size_t>(place);
  const PolarAxes axes = axes_at(x, z, r);
  add_centre({0, r - grid.z_of(index), axes.along_t(snapshot.v_x[i], snapshot.v_z[i]),
              axes.along_r(snapshot.v_x[i], snapshot.v_z[i])},
             snapshot, i, rings[index]);
}

/// Parameters along a half branch at which it goes from ring to ring, with its ends.
void find_cuts(const LayerGrid& grid, const HalfBranch& b, std::vector<double>& cuts) {
  cuts = {0, 1};
  // |p + s t|^2 = R^2 at the boundaries R between the least and the greatest distance.
  const double a = b.toward_x * b.toward_x + b.toward_z * b.toward_z;
  const double half = b.x * b.toward_x + b.z * b.toward_z, c = b.x * b.x + b.z * b.z;
  if (!(a > 0)) return;
  const double nearest = std::clamp(-half / a, 0.0, 1.0);
  const auto distance = [&](double s) { return std::sqrt(std::max(0.0, c + s * (2 * half + s * a))); };
  const double greatest = std::max(distance(0), distance(1));
  for (double ring = std::ceil(distance(nearest) / grid.thickness); ring * grid.thickness < greatest;
       ++ring) {
    const double R = ring * grid.thickness, root = half * half - a * (c - R * R);
    if (!(root > 0)) continue;
    for (const double sign : {-1.0, 1.0})
      if (const double s = (-half + sign * std::sqrt(root)) / a; s > 0 && s < 1) cuts.push_back(s);
  }
  std::sort(cuts.begin(), cuts.end());
}

void add_half_branch(const LayerGrid& grid, const HalfBranch& b, std::vector<double>& cuts,
                     std::vector<LayerSum>& rings) {
  find_cuts(grid, b, cuts);
  for (std::size_t piece = 0; piece + 1 < cuts.size(); ++piece) {
    const double middle = (cuts[piece] + cuts[piece + 1]) / 2, length = cuts[piece + 1] - cuts[piece];
    const double place =
        std::floor(std::hypot(b.x + middle * b.toward_x, b.z + middle * b.toward_z) / grid.thickness);
    if (!(place < static_cast<double>(rings.size()))) continue;
    PlaneMatrix& sum = rings[static_cast<std::size_t>(place)].force_branch;
    for (const double offset : {-gauss_offset, gauss_offset}) {
      const double s = middle + offset * length, x = b.x + s * b.toward_x, z = b.z + s * b.toward_z;
      const PolarAxes axes = axes_at(x, z, std::hypot(x, z));
      const double f_t = axes.along_t(b.force_x, b.force_z), f_r = axes.along_r(b.force_x, b.force_z);
      // The branch points from the contact to the centre: against `toward`.
      const double b_t = -length / 2 * axes.along_t(b.toward_x, b.toward_z);
      const double b_r = -length / 2 * axes.along_r(b.toward_x, b.toward_z);
      sum.xx += f_t * b_t;
      sum.xz += f_t * b_r;
      sum.zx += f_r * b_t;
      sum.zz += f_r * b_r;
    }
  }
}

}  // namespace

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

void add_to_rings(const LayerGrid& grid, const FlowSnapshot& snapshot, std::vector<LayerSum>& rings) {
  for (std::size_t i = 0; i < snapshot.x.size(); ++i) add_to_rings(grid, snapshot, i, rings);
  std::vector<double> cuts;
  for (const HalfBranch& branch : snapshot.half_branches()) add_half_branch(grid, branch, cuts, rings);
}

}  // namespace drumlin::particles
