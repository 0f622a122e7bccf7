#pragma once
// A drum through time: steps with inertia while its speed of rotation rises to that of the scene.
#include <functional>
#include <string>

#include "continuum/fem/flow_solver.hpp"
#include "continuum/postprocessing/flow_case.hpp"
#include "continuum/time_stepping/march_state.hpp"

namespace drumlin::continuum {

struct DrumMarch {
  FlowTime time;
  double time_unit_s = 1;  ///< sqrt(d/g)
  double rotation_rpm = 0;
  MarchState start;
  std::string start_name = "rest";                ///< for the report
  std::function<FlowCase(double share)> case_at;  ///< at a share of the speed of rotation
  FlowSolverOptions options;
};

/// Of a scene of a drum with steps in time, from rest. Throws InputError as flow_case().
DrumMarch drum_march(const FlowScene& scene, const RheologyFit& law);

/// Speed of the drum at a time (s) over that of the scene: from the start's linearly to 1 over the ramp.
double speed_share(const DrumMarch& march, double time_s);

/// One finished step.
struct MarchStep {
  int step = 0;  ///< from 1
  double time = 0, time_s = 0;
  double rotation_rpm = 0;
  ScalarSet scalars;
  int iterations = 0;   ///< halved steps included
  double residual = 0;  ///< the last
};

struct MarchObserver {
  std::function<void(const MarchStep&)> stepped;  ///< after each step, on every rank
  std::function<void(const MarchState&)>
      kept;                           ///< after every time.every steps and after the last, on every rank
  std::function<bool()> interrupted;  ///< asked between iterations
};

/// Marches to the end; after every time.every steps it goes on from what it kept, so that a march resumed
/// from there has the same bits (on one rank). The report is that of the steps done here; not converged: its
/// failure names the step. Collective.
FlowSolution march_drum(const DrumMarch& march, const MarchObserver& observer);

}  // namespace drumlin::continuum
