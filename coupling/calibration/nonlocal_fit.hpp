#pragma once
// The length over which flow spreads, read off particle maps: nonlocal fluidity with a threshold
// (docs/theory/rheology.md), its amplitude A and its threshold mu_s, and whether the runs ask for either.
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "coupling/calibration/friction_form.hpp"
#include "coupling/calibration/path_fields.hpp"
#include "coupling/core/law/rheology_fit.hpp"

namespace drumlin::coupling {

/// A node with what surrounds it: g = 2|D|/mu, mu = |s|/p.
struct FluidityPoint {
  double x = 0, z = 0;  ///< d
  long sector = 0;      ///< about the drum's axis, sector_deg wide: what is left out for an interval
  double I = 0;
  double mu = 0;
  double curvature = 0;  ///< lap g/g, per d^2; 1/xi^2 where the local law does not flow
};

struct FluidityOptions {
  double spacing = 4;         ///< d, between points
  double reach = 6;           ///< d, radius of the nodes that ln g is fitted over, a quadratic in x and z
  double surface_margin = 3;  ///< d
  double wall_margin = 4;     ///< d
  std::size_t least_nodes = 40;
};
std::vector<FluidityPoint> fluidity_points(const PathFields& fields, const FluidityOptions& options = {});

struct FluidityOfRun {
  std::string name;
  std::vector<FluidityPoint> points;
};

/// Points with mu in a range, means over all runs; xi is NaN where g does not curve upwards in the mean.
struct LengthOverFriction {
  double mu_from = 0, mu_to = 0;
  std::size_t points = 0;
  double I = 0;          ///< geometric mean
  double curvature = 0;  ///< mean, per d^2
  double xi() const;     ///< d
};

struct NonlocalFit {
  /// mu = max(mu_loc(I), mu_s) - A^2 lap g/g, least squares over all points; A = 0: no length is asked for.
  NonlocalLength law;
  std::size_t points = 0;
  double rms = std::numeric_limits<double>::quiet_NaN();  ///< of mu over all points
  double rms_bed = rms;                                   ///< over those with I < bed_I
  double local_rms = rms, local_rms_bed = rms;            ///< of mu_loc(I), which creeps at any mu
  double correlation_bed = rms;  ///< of mu and lap g/g where I < bed_I; -1 where a threshold stops the flow
  std::vector<std::pair<double, NonlocalLength>> given;  ///< rms in the bed at given mu_s with its best A
  std::vector<LengthOverFriction> lengths;
  std::vector<std::string> untold;  ///< what the runs cannot tell, as sentences

  /// Whether the amplitude lies outside its own interval of nought: what is not told is no part of a law.
  bool is_told() const;
};

/// `amount`: mu_loc, |s|/p over I of the same runs. Intervals of 99 %: one sector of the drum (in all runs)
/// left out each, with Student's t. Throws InputError where fewer than 50 points lie in the bed.
NonlocalFit fit_nonlocal(std::span<const FluidityOfRun> runs, const FormCurve& amount);

}  // namespace drumlin::coupling
