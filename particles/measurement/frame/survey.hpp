#pragma once
// Survey of a run, its first reading: the frame to measure in, and the series over time.
#include <cstddef>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "particles/measurement/frame/flow_frame.hpp"
#include "particles/measurement/frame/recording.hpp"

namespace drumlin::particles {

/// How the direction of the surface was found.
enum class FrameSource { isoline, centre_of_mass, gravity, domain };
std::string name_of(FrameSource source);

/// One value per snapshot.
struct TimeSeries {
  std::vector<double> time;
  std::vector<double> wall_angle;      ///< rad turned so far, clockwise
  std::vector<double> mass_angle;      ///< rad, of the centre of mass; empty without a container
  std::vector<double> kinetic_energy;  ///< of the motion relative to the drum, rho0 g d^3 per unit depth
};

/// What the first reading finds out.
struct Survey {
  FlowFrame upright;              ///< z against gravity; along the laboratory's axes when x is periodic
  std::vector<CoverageMap> maps;  ///< one per batch; empty without a container
  TimeSeries series;
  double x_min = 0, x_max = 0, z_min = 0, z_max = 0;  ///< what the grains reach in `upright`
};

/// Reads every snapshot once; `tick` is called after each.
Survey survey(const Recording& recording, std::size_t batches, const std::function<void()>& tick);

/// Slope of the surface with its 99 % half width (rad): the isoline of all maps, and without one batch each.
struct SlopeEstimate {
  Slope slope;
  double ci99 = std::numeric_limits<double>::quiet_NaN();
};
SlopeEstimate slope_estimate(const Survey& found, double first_guess, const SlopeOptions& options);

}  // namespace drumlin::particles
