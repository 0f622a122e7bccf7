#pragma once
// Stretches beyond the end of a run with half its time step and with a third of its tolerance: what both
// settings leave of error in what the grains do on average.
#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "particles/scene/scene.hpp"
#include "particles/stepping/simulation.hpp"

namespace drumlin::particles {

/// What is compared, as means over the grains or contacts (trajectories themselves part within some
/// collisions): the energy of all grains, rho0 g d^3 per unit depth; the normal force of the contacts that
/// carry one, rho0 g d^2; half the sum of r f_n over both sides of the contacts, over the area of the discs,
/// rho0 g d; rms over the grains, in a tenth of the stretch, d; of loaded contacts before the projection, d.
constexpr std::array<const char*, 5> stretch_quantities{"kinetic_energy", "contact_force", "pressure",
                                                        "displacement", "overlap"};

constexpr std::size_t stretch_blocks = 10;

/// One stretch: the mean of each quantity in each of ten parts of equal length; NaN where nothing is there to
/// be averaged, or where grains came or went in between.
struct StretchMeans {
  std::array<std::array<double, stretch_blocks>, stretch_quantities.size()> blocks;
  double cpu_seconds = 0;
  std::int64_t steps = 0, missed = 0;  ///< missed: of the tolerance of the stretch
};

/// A difference between two stretches from one state, block by block, with its 99 % half width (Student's t
/// with the correlation of neighbours, as all intervals over time).
struct StretchChange {
  double change = 0, ci99 = 0;
  /// Largest error of the run that agrees with it: (|change| + ci99) times what the order of the setting asks
  /// for.
  double error_at_most = 0;
};

struct StretchComparison {
  std::string quantity;
  double value = 0;            ///< mean over the stretch with the settings of the run
  StretchChange step, solver;  ///< with half the step; with a third of the tolerance
};

struct PairedStretches {
  double seconds = 0;          ///< simulated, each
  double cpu_seconds = 0;      ///< of all three
  std::array<double, 3> cost;  ///< processor seconds: as the run, half the step, a third of the tolerance
  std::int64_t missed = 0;     ///< steps of all three that missed their tolerance
  std::vector<StretchComparison> quantities;  ///< those that were there
};

/// An error that is proportional to the step is twice the change by halving it; one that goes as the root of
/// the tolerance 1/(1 - 1/sqrt(3)) times the change by a third of it (one in proportion to it less).
constexpr double error_over_step_change = 2;
constexpr double error_over_solver_change = 2.3660254037844386;

/// Goes on from the state at the end of a scene for `seconds`, under the motions of its last stage, three
/// times. `after_step` may throw to end it. Throws NotConvergedError when a grain is lost.
PairedStretches paired_stretches(const Scene& scene, const SimulationState& end, double seconds, int threads,
                                 const std::function<void()>& after_step);

/// One of them: steps of at most `step_s`, whole in each tenth.
StretchMeans stretch_means(const Scene& scene, const SimulationState& end, double seconds, double step_s,
                           double tolerance, int threads, const std::function<void()>& after_step);

/// What two stretches differ by; `factor`: of error_at_most.
StretchChange change_between(const std::array<double, stretch_blocks>& before,
                             const std::array<double, stretch_blocks>& after, double factor);

}  // namespace drumlin::particles
