#pragma once
// Survey of a run, its first reading: the frame to measure in, and the series over time.
#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "particles/measurement/frame/flow_frame.hpp"
#include "particles/measurement/frame/recording.hpp"

namespace drumlin::particles {

/// How the direction of the surface was found.
enum class FrameSource { isoline, centre_of_mass, gravity, domain };
constexpr auto names_of(FrameSource) { return std::array{"isoline", "centre of mass", "gravity", "domain"}; }

/// One value per snapshot.
struct TimeSeries {
  std::vector<double> time;
  std::vector<double> wall_angle;      ///< rad turned so far, clockwise
  std::vector<double> mass_angle;      ///< rad, of the centre of mass; empty without a container
  std::vector<double> kinetic_energy;  ///< of the motion relative to the drum, rho0 g d^3 per unit depth
  std::vector<double> speed;           ///< root mean square of the same motion over the mass of the grains
  /// Without a container: sum over contacts of F_a b_a / 2 and of -F_x b_z, over the area of all grains; mean
  /// shear rate: slope of v_x over z among the grains that touch something. NaN where no contact is known.
  std::vector<double> pressure, shear_stress, shear_rate;
};

/// What the first reading finds out.
struct Survey {
  FlowFrame upright;  ///< z against gravity; along the laboratory's axes when x is periodic
  std::optional<CoverageBatches> coverage;  ///< nothing without a container
  TimeSeries series;
  Rectangle reach = no_rectangle;  ///< of the grains in `upright`, or the window
  bool closed = false;             ///< periodic in z too: its z are the mean ends of the cell
  double cell_length = 0;          ///< of such a cell, in the mean
  bool cut_to_window = false;      ///< some grains lie outside of it (dense_window.hpp)
};

/// Reads every snapshot once; `tick` is called after each. Where the grains of an open scene reach further
/// than the limits of a window, the window is measured, and the frame's x counts from its middle.
Survey survey(const Recording& recording, std::size_t batches, std::shared_ptr<ScratchFile> file,
              const std::function<void()>& tick);

/// Slope of the surface with its 99 % half width (rad): the isoline of all maps, and without one batch each.
struct SlopeEstimate {
  Slope slope;
  double ci99 = std::numeric_limits<double>::quiet_NaN();
};
SlopeEstimate slope_estimate(const Survey& found, double first_guess, const SlopeOptions& options);

}  // namespace drumlin::particles
