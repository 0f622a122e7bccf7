#include "particles/measurement/frame/flow_frame.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "coupling/core/statistics/straight_line.hpp"
#include "particles/measurement/frame/disc_area.hpp"

namespace drumlin::particles {

FlowFrame FlowFrame::at_slope(double theta) const {
  const double cosine = std::cos(theta), sine = std::sin(theta);
  return {origin_x, origin_z, cosine * x_axis_x + sine * x_axis_z, cosine * x_axis_z - sine * x_axis_x};
}

FlowFrame frame_at_slope(double origin_x, double origin_z, double gravity_x, double gravity_z, double theta) {
  const double gravity = std::hypot(gravity_x, gravity_z);
  const double up_x = gravity > 0 ? -gravity_x / gravity : 0;
  const double up_z = gravity > 0 ? -gravity_z / gravity : 1;
  return FlowFrame{origin_x, origin_z, up_z, -up_x}.at_slope(theta);
}

Snapshot mirrored(Snapshot snapshot) {
  const auto negate = [](std::vector<double>& values) {
    for (double& value : values) value = -value;
  };
  negate(snapshot.x);
  negate(snapshot.v_x);
  negate(snapshot.spin);
  negate(snapshot.displacement_x);
  snapshot.wall_angle = -snapshot.wall_angle;
  snapshot.wall_spin = -snapshot.wall_spin;
  snapshot.container_x = -snapshot.container_x;
  snapshot.gravity_x = -snapshot.gravity_x;
  for (SnapshotContact& contact : snapshot.contacts) {
    contact.normal_x = -contact.normal_x;
    contact.impulse_t = -contact.impulse_t;  // the tangent follows its normal clockwise in the mirror too
  }
  return snapshot;
}

double centre_of_mass_angle(const Snapshot& snapshot, const FlowFrame& upright) {
  double mass = 0, x = 0, z = 0;
  for (std::size_t i = 0; i < snapshot.x.size(); ++i) {
    const double weight = snapshot.mass.empty() ? snapshot.radius[i] * snapshot.radius[i] : snapshot.mass[i];
    mass += weight;
    const auto [here_x, here_z] = upright.place(snapshot.x[i], snapshot.z[i]);
    x += weight * here_x;
    z += weight * here_z;
  }
  return std::atan2(-x / mass, -z / mass);
}

void CoverageMap::add(const Snapshot& snapshot, const FlowFrame& frame) {
  for (std::size_t i = 0; i < snapshot.x.size(); ++i) {
    const auto [x, z] = frame.place(snapshot.x[i], snapshot.z[i]);
    add_disc(x - grid_.x_min, z - grid_.z_min, snapshot.radius[i]);
  }
  ++snapshots_;
}

void CoverageMap::add_disc(double x, double z, double radius) {
  const auto first = [](double centre, double r) { return std::max(0.0, std::floor(centre - r)); };
  const auto end = [](double centre, double r, double cells) {
    return std::min(cells, std::ceil(centre + r));
  };
  const double west = first(x, radius), east = end(x, radius, grid_.columns);
  const double south = first(z, radius), north = end(z, radius, grid_.rows);
  if (!(west < east && south < north)) return;
  // Area below and to the left of each corner of the cells: one evaluation a corner, where each cell alone
  // would need all four of its own.
  std::vector<double>& below = corners_;
  below.assign(static_cast<std::size_t>(east - west) + 1, 0.0);
  for (std::size_t c = 0; c < below.size(); ++c)
    below[c] = disc_area_in_quadrant(radius, west + static_cast<double>(c) - x, south - z);
  for (double row = south; row < north; ++row) {
    double* cells = &area_[*grid_.cell(west, row)];
    double left = 0;  // of the row, left of the corner before
    for (std::size_t c = 0; c < below.size(); ++c) {
      const double corner = disc_area_in_quadrant(radius, west + static_cast<double>(c) - x, row + 1 - z);
      const double strip = corner - below[c];
      if (c > 0) cells[c - 1] += strip - left;
      left = strip;
      below[c] = corner;
    }
  }
}

void add_times(double factor, const CoverageMap& from, CoverageMap& to) {
  for (std::size_t i = 0; i < to.area_.size(); ++i) to.area_[i] += factor * from.area_[i];
  to.snapshots_ += factor * from.snapshots_;
}

CoverageBatches::CoverageBatches(const CoverageMap& empty, std::shared_ptr<ScratchFile> file)
    : empty_(empty), newest_(empty), file_(std::move(file)) {}

void CoverageBatches::add(const Snapshot& snapshot, const FlowFrame& frame, std::size_t batch) {
  for (; stored_.size() < batch; newest_ = empty_)
    stored_.push_back({file_->append(std::as_bytes(std::span(newest_.area_))), newest_.snapshots_});
  newest_.add(snapshot, frame);
}

CoverageMap CoverageBatches::batch(std::size_t b) const {
  if (b == stored_.size()) return newest_;
  CoverageMap map = empty_;
  file_->read(stored_[b].place, std::as_writable_bytes(std::span(map.area_)));
  map.snapshots_ = stored_[b].snapshots;
  return map;
}

CoverageMap CoverageBatches::whole() const {
  CoverageMap sum = batch(0);
  for (std::size_t b = 1; b < size(); ++b) add_times(1, batch(b), sum);
  return sum;
}

double CoverageMap::volume_fraction(double x, double z) const {
  double area = 0;
  grid_.each_around(x, z, [&](std::size_t cell, double weight) { area += weight * area_[cell]; });
  return snapshots_ > 0 ? area / snapshots_ : 0;
}

namespace {

constexpr double ray_step = 0.25;    // d, a quarter of a cell
constexpr double ray_spacing = 0.5;  // d

/// Highest z in the frame turned by theta at which the volume fraction reaches the isoline, looking down from
/// above.
std::optional<double> isoline_height(const CoverageMap& map, double theta, double x, double isoline) {
  const double cosine = std::cos(theta), sine = std::sin(theta);
  const auto fraction = [&](double z) {
    return map.volume_fraction(x * cosine + z * sine, z * cosine - x * sine);
  };
  const double reach = std::max(std::abs(map.z_min()), std::abs(map.z_max()));
  double above = fraction(reach);
  for (double z = reach - ray_step; z > -reach; z -= ray_step) {
    const double here = fraction(z);
    if (here >= isoline && above < isoline) return z + ray_step * (here - isoline) / (here - above);
    above = here;
  }
  return std::nullopt;
}

double cut_half_width(double surface_z, const SlopeOptions& options) {
  if (!(options.container_radius > 0)) return options.half_width;
  const double square = options.container_radius * options.container_radius - surface_z * surface_z;
  return std::min(options.half_width, std::sqrt(std::max(0.0, square)) / 2);
}

/// z over x in the frame tried.
std::optional<statistics::StraightLine> fitted_isoline(const CoverageMap& map, double theta,
                                                       double half_width, double isoline) {
  std::vector<double> places, heights;
  const double rays = std::floor(half_width / ray_spacing);
  for (double ray = -rays; ray <= rays; ++ray) {
    const double x = ray * ray_spacing;
    const auto z = isoline_height(map, theta, x, isoline);
    if (!z) continue;
    places.push_back(x);
    heights.push_back(*z);
  }
  return places.size() < 3 ? std::nullopt : statistics::fit_line(places, heights);
}

}  // namespace

Slope isoline_slope(const CoverageMap& upright_map, double first_guess, const SlopeOptions& options) {
  constexpr int most_iterations = 50;
  constexpr double tolerance = 1e-6;  // rad, far below any interval of an angle
  double theta = first_guess;
  const auto middle = isoline_height(upright_map, theta, 0, options.isoline);
  if (!middle) return {};
  double half_width = cut_half_width(*middle, options);
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    const auto line = fitted_isoline(upright_map, theta, half_width, options.isoline);
    if (!line) return {};
    const double correction = std::atan(line->slope);
    theta -= correction;
    half_width = cut_half_width(line->intercept, options);
    if (std::abs(correction) < tolerance) return Slope{theta, half_width, line->intercept};
  }
  return {};
}

}  // namespace drumlin::particles
