#pragma once
// A flow with a free surface through time: the material alone is meshed, its mesh follows it (arbitrary
// Lagrangian-Eulerian) and is made anew where it tangles.
#include <functional>
#include <vector>

#include "continuum/fem/flow_solver.hpp"
#include "continuum/model/region.hpp"

namespace drumlin::continuum {

struct RegionMarch {
  Region region;
  /// Law, density, regularisation, slope: the direction of the weight. Domain and sides are the region's.
  FlowProblem problem;
  std::function<double(Vec2)> size;  ///< of the triangles
  double step = 0;                   ///< the largest
  double end = 0;
  int halvings = 6;  ///< of a step that fails
};

/// Sums over the steps so far.
struct RegionTotals {
  double fill = 0;  ///< area of the material at the start
  double weight_work = 0;
  double energy_error = 0;  ///< of the steps, with its sign
  double mass_error = 0;    ///< largest abs(area inside + discharged - fill) over the fill
  int iterations = 0;
};

/// What a flow goes on from. Bit for bit: the mesh is kept, not made anew.
struct RegionState {
  double time = 0;
  int steps = 0;
  int steps_on_mesh = 0;  ///< since it was made
  RegionMesh mesh = {};   ///< its vertices where they are now
  double area = 0;        ///< that the material has to have
  double discharged = 0;  ///< area that has left
  double kinetic_energy = 0;
  RegionTotals totals = {};
  std::vector<double> values = {};  ///< of the unknowns, in deal.II's order on this mesh
  /// What they and the corners of the triangles change by in time; empty at a start, after an event and on a
  /// new mesh.
  std::vector<double> rates = {};
  std::vector<Vec2> corner_rates = {};
};

/// One finished step.
struct RegionStep {
  int step = 0;  ///< from 1
  double time = 0, time_step = 0;
  int iterations = 0;   ///< halved steps included
  double residual = 0;  ///< the last
  double area = 0;      ///< of the mesh
  double discharged = 0;
  double discharge_rate = 0;
  double fastest = 0;       ///< largest speed of a corner
  FlowIntegrals sums;       ///< at its end
  std::vector<Vec2> loads;  ///< of the last step: force of the material on each part of the region
  /// Work of the weight and of the walls over the step (power at its middle), less what was lost to the law
  /// and to friction, gained as kinetic energy or carried out: nought but for the error of the step.
  double energy_error = 0;
  int cells = 0;
  bool remeshed = false;
};

struct RegionObserver {
  std::function<void(const RegionStep&)> stepped;
  std::function<void(const FlowField&)> ended;  ///< of a march that has converged
  std::function<bool()> interrupted;
};

/// Marches from `start` to the end. Not converged: the failure names time and reason. Collective; with
/// inertia, by TR-BDF2; the mesh at the middle of a step says how far that at its end has moved.
FlowReport march_region(const RegionMarch& march, RegionState& state, const FlowSolverOptions& options,
                        const RegionObserver& observer);

/// The fill at rest, meshed.
RegionState filled(const RegionMarch& march);

/// A state as a flow; its stresses are those of the steady law.
FlowField flow_of(const RegionMarch& march, const RegionState& state);

}  // namespace drumlin::continuum
