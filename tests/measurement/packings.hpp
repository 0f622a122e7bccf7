#pragma once
// Packings whose profiles are known by hand.
#include <cmath>
#include <numbers>
#include <string>

#include "particles/measurement/measurement.hpp"

namespace drumlin::testing {

inline void add_grain(particles::Snapshot& snapshot, double x, double z, double radius) {
  snapshot.x.push_back(x);
  snapshot.z.push_back(z);
  snapshot.radius.push_back(radius);
  snapshot.v_x.push_back(0);
  snapshot.v_z.push_back(0);
  snapshot.spin.push_back(0);
}

/// Touching discs of diameter 1 on a hexagonal lattice with rows along x, periodic in x.
inline particles::Snapshot hexagonal_layer(int columns, int rows) {
  particles::Snapshot snapshot;
  snapshot.time_step = 0.01;
  snapshot.period_x = columns;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column)
      add_grain(snapshot, column + (row % 2 == 0 ? 0.25 : 0.75), (row + 0.5) * std::sqrt(3.0) / 2, 0.5);
  return snapshot;
}

/// Columns of discs of diameter 1 side by side on a floor at z = 0 (wall 0), periodic in x; each contact
/// carries what lies above it in a gravity of 1 tilted by `slope` towards +x.
inline particles::Snapshot stacked_columns(int columns, int height, double slope) {
  particles::Snapshot snapshot;
  snapshot.time_step = 0.01;
  snapshot.period_x = columns;
  snapshot.gravity_x = std::sin(slope);
  snapshot.gravity_z = -std::cos(slope);
  for (int column = 0; column < columns; ++column)
    for (int level = 0; level < height; ++level) {
      const auto grain = static_cast<std::int32_t>(snapshot.x.size());
      add_grain(snapshot, column + 0.5, level + 0.5, 0.5);
      const double impulse = (height - level) * std::numbers::pi / 4 * snapshot.time_step;
      // The normal points up, its tangent to +x: the contact holds the grain back against the slope.
      snapshot.contacts.push_back(
          {grain, level == 0 ? -1 : grain - 1, 0, 1, impulse * std::cos(slope), -impulse * std::sin(slope)});
    }
  return snapshot;
}

/// A drum of radius R about (3, -2), filled with a hexagonal lattice up to a straight surface that lies
/// `depth` below the axis and slopes down towards +x by theta. It turns clockwise with `spin`; grains are at
/// rest in it.
inline particles::Snapshot filled_drum(double radius, double depth, double theta, double spin) {
  particles::Snapshot snapshot;
  snapshot.time_step = 0.01;
  snapshot.container_x = 3;
  snapshot.container_z = -2;
  snapshot.container_radius = radius;
  snapshot.wall_spin = spin;
  const double row_height = std::sqrt(3.0) / 2;
  const int reach = static_cast<int>(2 * radius);
  for (int row = 1; row < 2 * reach; ++row)
    for (int column = -reach; column <= reach; ++column) {
      const double x = column + (row % 2 == 0 ? 0.0 : 0.5), z = -depth - (row - 0.5) * row_height;
      if (std::hypot(x, z) > radius - 0.5) continue;
      const double right = x * std::cos(theta) + z * std::sin(theta);
      const double up = z * std::cos(theta) - x * std::sin(theta);
      add_grain(snapshot, 3 + right, -2 + up, 0.5);
      snapshot.v_x.back() = spin * up;
      snapshot.v_z.back() = -spin * right;
      snapshot.spin.back() = spin;
    }
  return snapshot;
}

/// Everything turned anticlockwise by an angle about the laboratory's origin, gravity too.
inline particles::Snapshot turned(particles::Snapshot snapshot, double angle) {
  const double cosine = std::cos(angle), sine = std::sin(angle);
  const auto turn = [&](auto& x, auto& z) {
    const double old_x = x, old_z = z;
    x = static_cast<std::remove_reference_t<decltype(x)>>(cosine * old_x - sine * old_z);
    z = static_cast<std::remove_reference_t<decltype(z)>>(sine * old_x + cosine * old_z);
  };
  for (std::size_t i = 0; i < snapshot.x.size(); ++i) {
    turn(snapshot.x[i], snapshot.z[i]);
    turn(snapshot.v_x[i], snapshot.v_z[i]);
    if (!snapshot.displacement_x.empty()) turn(snapshot.displacement_x[i], snapshot.displacement_z[i]);
  }
  turn(snapshot.container_x, snapshot.container_z);
  turn(snapshot.gravity_x, snapshot.gravity_z);
  for (particles::SnapshotContact& contact : snapshot.contacts) turn(contact.normal_x, contact.normal_z);
  return snapshot;
}

inline particles::SnapshotSource source_of(std::vector<particles::Snapshot> snapshots) {
  const std::size_t count = snapshots.size();
  return {count, [all = std::move(snapshots)](std::size_t index) { return all.at(index); }};
}

inline particles::Measurement measurement_of(const particles::Snapshot& snapshot,
                                             const particles::MeasurementOptions& options = {}) {
  return particles::measurement(source_of({snapshot}), options);
}

/// A number of one layer.
inline double at(const particles::Measurement& measured, const std::string& name, std::size_t layer) {
  return measured.profiles.column(name).value.at(layer);
}

}  // namespace drumlin::testing
