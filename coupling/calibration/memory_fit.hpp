#pragma once
// The memory of the stress's axes fitted along the paths of the material: law N1 of docs/theory/rheology.md
// with the particles' motion given.
#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "coupling/calibration/friction_form.hpp"
#include "coupling/calibration/stress_paths.hpp"

namespace drumlin::coupling {

/// Coefficients of the law: v.grad A + 2 i W A = 2 c |D| (e^(i chi(I)) n - A), s/p = mu(I) (n + m A)/rho,
/// v.grad rho = 2 c_rho |D| (|n + m A| - rho); rho = |n + m A| at once without c_rho.
struct AxisMemory {
  double c = 0;
  double m = 0;
  double chi = 0;  ///< rad, below I_low; atan(1/c) above I_high
  std::optional<double> c_rho = {};
  double I_low = 1e-3, I_high = 1e-2;
};

/// chi at an inertial number, smooth in ln I.
double lead_angle(const AxisMemory& law, double ln_I);

/// Number of the sector about the drum's axis, sector_deg wide, in which a path ends: what is left out for an
/// interval.
constexpr double sector_deg = 15;
long sector_of(const StressPath& path);

/// A at the end of a path. Exact over each step, on which D, W and I are constant; before its first step the
/// path was in steady state without spin.
Deviator carried_memory(const StressPath& path, const AxisMemory& law);

/// (n + m A)/rho at the end of a path: s/p over the amount mu(I). As carried_memory().
Deviator carried_axes(const StressPath& path, const AxisMemory& law);

/// Paths of one run with the amount mu(I) at their ends.
struct PathsOfRun {
  std::string name;
  std::vector<StressPath> paths;
  std::vector<double> amounts;  ///< one per path
};
PathsOfRun paths_of_run(std::string name, std::vector<StressPath> paths, const FormCurve& amount);

enum : std::size_t { memory_c, memory_m, memory_chi };  ///< places of the coefficients in arrays

/// Coefficients found by least squares of s/p, those that are free.
struct MemoryFit {
  AxisMemory law;
  std::array<bool, 3> free{};
  double rms = std::numeric_limits<double>::quiet_NaN();  ///< of |s/p - law| over all paths
  double cost =
      std::numeric_limits<double>::quiet_NaN();  ///< mean of the bounded squares that were made least
  std::size_t paths = 0;
  bool converged = false;
  /// Half widths of 99 % intervals of c, m, chi; NaN of one that is held or was not found.
  std::array<double, 3> ci99_sectors{}, ci99_runs{};
  /// Of c and m, c and chi, m and chi, over the sectors that were left out.
  std::array<double, 3> correlation{};
  /// The cost with one sector left out each, the coefficients of all.
  std::vector<double> cost_without;
};

/// Minimises the sum over paths of rho(|s/p - law|/0.05), rho(x) = 2 (sqrt(1 + x^2) - 1), by steps of Gauss
/// and Newton from `start`, of which what is not free is held. m stays within 0 ... 2 and c within 0.3 ...
/// 100. Intervals: one sector of the drum (15 deg about its axis, in all runs) left out each, by one step
/// from the minimum, with Student's t; and, with two runs at least, from the spread of what each run gives
/// alone.
MemoryFit fit_memory(std::span<const PathsOfRun> runs, const AxisMemory& start,
                     const std::array<bool, 3>& free);

/// ci99_runs: with two runs at least, from the spread of what each run gives alone.
void add_run_intervals(std::span<const PathsOfRun> runs, MemoryFit& fit);

constexpr double bed_I = 1e-3;  ///< below it a path ends in the bed

/// What is left of a run: root mean squares over its paths in the bed and in the flow.
struct MemoryScore {
  struct Zone {
    std::size_t paths = 0;
    double rms = std::numeric_limits<double>::quiet_NaN();  ///< of |s/p - law|
    double axes_deg = rms;  ///< of the angle from the law's axes to the stress's
    double rms_without_memory = rms, axes_deg_without_memory = rms;  ///< of mu(I) n, which remembers nothing
  };
  std::string run;
  Zone bed, flow;
};
MemoryScore memory_score(const PathsOfRun& run, const AxisMemory& law);

/// Axes along an arc about the drum's axis, as angles in degrees from those of simple shear along x, by the
/// angle from straight below the axis; means over bins of 5 deg with three paths at least.
struct AxesOnArc {
  double radius_from = 0, radius_to = 0;  ///< d
  std::vector<double> angle_deg, stress_deg, law_deg, rate_deg, amount, law_amount;
};
std::vector<AxesOnArc> axes_on_arcs(std::span<const PathsOfRun> runs, const AxisMemory& law,
                                    double drum_radius);

}  // namespace drumlin::coupling
