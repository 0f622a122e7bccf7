#pragma once
// A sweep over the settings of a particle scene: which points it has, and where their errors can be read.
#include <span>
#include <string>
#include <vector>

#include "coupling/accuracy/sweep_axes.hpp"

namespace drumlin::coupling {

/// What decides how accurately a step of the grains is solved.
struct ParticleSettings {
  std::string solver;
  double tolerance = 0;  ///< of the residual
  double step_s = 0;
  bool operator==(const ParticleSettings&) const = default;
};
std::string name_of(const ParticleSettings& settings);

/// What scenes of particles can be swept over.
const std::vector<std::string>& particle_axes();

struct ParticleSweep {
  ParticleSettings standard;  ///< the scene's own
  std::vector<ParticleSettings> points;
  ParticleSettings reference;  ///< what the points are measured against
  ParticleSettings finest;     ///< the point closest to it: what the reference itself is worth
  /// Of the same step, solved as tightly as the reference.
  ParticleSettings tight(double step_s) const;
};

/// Every tolerance with every step by the scene's solver, and every other solver at the scene's step. Throws
/// InputError for a solver that is not in `known_solvers`.
ParticleSweep particle_sweep(const ParticleSettings& standard, const std::vector<SweepAxis>& axes,
                             const std::vector<std::string>& known_solvers);

/// The last place at which the finest point still follows the reference, given its errors of the velocity
/// field at each: two sequences of impacts make a difference grow with time, whatever its size was. The first
/// place if there is none.
std::size_t last_followed(std::span<const double> field_errors);

}  // namespace drumlin::coupling
