#pragma once
// The state of all grains at one instant, frozen: what a run leaves and what measurement reads.
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "coupling/core/basics/scales.hpp"

namespace drumlin::particles {

/// A loaded contact. The normal points from body j to body i; the impulse acts on i (and its opposite on j).
/// tangent = normal turned clockwise by 90 degrees: (n_z, -n_x).
struct SnapshotContact {
  std::int32_t i = 0;  ///< grain
  std::int32_t j = 0;  ///< grain, or -1 - w for wall shape w
  float normal_x = 0;
  float normal_z = 0;
  double impulse_n = 0;  ///< over the last step; divide by `time_step` for a force
  double impulse_t = 0;
};
/// Components along x and z.
inline std::array<double, 2> impulse_on_i(const SnapshotContact& c) {
  const double n_x = c.normal_x, n_z = c.normal_z;
  return {c.impulse_n * n_x + c.impulse_t * n_z, c.impulse_n * n_z - c.impulse_t * n_x};
}

/// A loaded contact of spheres, components x, z, y: the normal points from j to i, the force acts on i.
struct SphereContact {
  std::int32_t i = 0, j = 0;  ///< j < 0: a wall
  std::array<double, 3> normal{}, force{};
};

/// What spheres have beside their view along y, in which a snapshot holds them per depth of a slab
/// (docs/theory/measurement.md#spheres). Its `contacts` are then empty.
struct SphereSlab {
  double depth = 1;
  std::vector<double> y, v_y;
  std::vector<char> outside;  ///< 1: the centre is not in the slab; empty: all are
  std::vector<SphereContact> contacts;
};

/// A cell that is periodic in x and z at one instant: its lower left corner, its height (its length is
/// Snapshot::period_x), the displacement of the image above along x, and the rates of all that: an image that
/// is displaced by s moves at (rate_x s_x + shear s_z, rate_z s_z).
struct SnapshotCell {
  double x = 0, z = 0, height = 0;
  double offset = 0;
  double rate_x = 0, rate_z = 0, shear = 0;
  bool operator==(const SnapshotCell&) const = default;
};

/// Dimensionless (d, sqrt(d/g), rho0 d^2 per unit depth for masses), laboratory frame, x to the right, z up.
/// Arrays have one entry per grain. Spins are positive in the sense of dv_x/dz (clockwise as drawn).
struct Snapshot {
  std::int64_t step = 0;
  double time = 0;
  double time_step = 0;
  double wall_angle = 0;  ///< rad turned so far by the first rotating wall, positive clockwise; 0 if none
  double wall_spin = 0;   ///< its angular velocity
  double container_x = 0, container_z = 0,
         container_radius = 0;           ///< first circular container; radius 0 if none
  double gravity_x = 0, gravity_z = -1;  ///< body acceleration
  double velocity_window = 0;            ///< 0: no displacements stored
  double period_x = 0;                   ///< length of the periodic domain; 0: open
  /// Displacement of each wall from where the scene has it: p -> R(angle) p + (x, z). Empty unless the scene
  /// moves a wall by a force or ends stages early: else they follow from the scene and the time.
  std::vector<double> wall_pose_angle, wall_pose_x, wall_pose_z;
  std::vector<std::int32_t>
      wall_open;  ///< of each wall, 1: a stage has opened it; empty unless one opens any
  Scales scales;
  std::vector<double> x, z, v_x, v_z, radius;
  std::vector<double> spin;  ///< empty when the scene has no spin
  std::vector<double> displacement_x,
      displacement_z;  ///< over the velocity window (laboratory frame); empty when not stored
  std::vector<SnapshotContact> contacts;  ///< contacts that carry an impulse
  /// Identities, ascending and never given twice; empty where the number of grains cannot change.
  std::vector<std::int64_t> id;
  std::vector<double> mass;               ///< empty where it is that of the radius, pi r^2
  bool contacts_known = true;             ///< false: the program that made it did not say where they are
  std::optional<SnapshotCell> cell = {};  ///< only in a domain that is periodic in z too
  std::optional<SphereSlab> spheres = {};
};

/// Mass of a grain: its own, or that of its radius.
double mass_of(const Snapshot&, std::size_t grain);

/// The indices of one grain in two snapshots.
struct SameGrain {
  std::size_t before = 0, now = 0;
};
/// The grains that are in both, by their identities; by their indices where snapshots have no identities, and
/// then none if the numbers of grains differ.
std::vector<SameGrain> same_grains(const Snapshot& before, const Snapshot& now);
std::vector<SameGrain> same_grains(std::span<const std::int64_t> id_before, std::size_t count_before,
                                   std::span<const std::int64_t> id_now, std::size_t count_now);

}  // namespace drumlin::particles
