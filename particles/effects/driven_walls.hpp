#pragma once
// Driven walls: a force and the contacts move a wall along one direction; across, its velocity is given.
// One body more in a step, with one velocity. Everything that is state of such a wall is its DrivenState.
#include <array>
#include <cstdint>
#include <span>

#include "coupling/core/basics/scales.hpp"
#include "coupling/core/documents/key_spec.hpp"
#include "particles/bodies/free_motion.hpp"
#include "particles/bodies/walls.hpp"
#include "particles/detection/candidate.hpp"
#include "particles/effects/wall_step.hpp"

namespace drumlin::particles {

/// The keys of a motion of kind "force".
struct ForceControl {
  std::array<double, 2> direction{0, 0};  ///< of the force and of the motion; its length does not matter
  double force_n_m = 0;  ///< per metre of depth: all that acts beside the grains, weight included
  double mass_kg_m = 0;
  std::array<double, 2> velocity_mm_s{0, 0};  ///< at right angles to the direction
};

/// The keys of a wall that is moved along a direction by a force or a pressure, `push`.
template <class Visitor, class Drive>
void describe_drive(Visitor& v, Drive& keys, const std::string& name, double& push, const std::string& unit) {
  v.value("direction", keys.direction,
          required("", at_least(-1e6, 1e6), "Direction [x, z]; its length does not matter."));
  v.value(name, push, required(unit, at_least(-1e12, 1e12), "All beside the grains, weight included."));
  v.value("mass_kg_m", keys.mass_kg_m, required("kg/m", above(0, 1e12), "Inertia, per metre of depth."));
  v.value("velocity_mm_s", keys.velocity_mm_s,
          defaulted("mm/s", at_least(-1e9, 1e9), "Velocity [v_x, v_z] across the direction."));
}

template <class Visitor>
void describe(Visitor& v, ForceControl& f) {
  describe_drive(v, f, "force_n_m", f.force_n_m, "N/m");
}

/// The law: direction, force and mass in the units of the simulation. `state`: its position among the states.
Driven driven_law(const ForceControl&, const Scales&, int state);

// Terms in a step.

/// Velocity along the direction at the end of a step in which the force alone acts.
inline double free_velocity(const Driven& wall, const DrivenState& state, double time_step) {
  return state.velocity + time_step * wall.force * wall.inverse_mass;
}
/// Adds driven walls to a step, as the force alone moves them.
void add_driven_walls(const Walls&, std::span<const DrivenState>, double time_step, WallStep&);

/// The driven wall of a pair, as its position in WallStep::driven; -1: none.
inline std::int32_t driven_wall_of(const WallStep& walls, const Candidate& pair) {
  return pair.j >= 0 || walls.driven_of_shape.empty() ? -1 : walls.driven_of_shape[-1 - pair.j];
}
/// v, changed along the wall's direction.
inline Point along(const Point& v, const Driven& wall, double change) {
  return {v.x + change * wall.direction.x, v.z + change * wall.direction.z};
}

/// Moves walls with the velocities that contacts left them (`motion.driven`): their states, and their shapes
/// and displacements at the end of the step.
void move_driven_walls(const FreeMotion& motion, double time_step, WallStep&, std::span<DrivenState>);
/// Moves driven wall k by `displacement` along its direction at the end of a step: position and shapes, not
/// velocity.
void shift_driven_wall(std::size_t k, double displacement, WallStep&, DrivenState&);

}  // namespace drumlin::particles
