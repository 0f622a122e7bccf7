#pragma once
// What the tensors of a particle map say of the law: friction and turn of the stress over the inertial
// number.
#include <string>
#include <vector>

#include "coupling/calibration/friction_form.hpp"
#include "coupling/calibration/log_friction.hpp"
#include "coupling/core/results/field_map.hpp"

namespace drumlin::coupling {

/// Where a map speaks of the law; lengths in d. Stresses and velocity gradients are averaged over blocks one
/// row high before invariants are formed: the length of a noisy tensor is too large, the more the slower the
/// flow, and along x the flow of a drum changes little.
struct BlockSelection {
  double I_min = 3e-5;
  double I_max = 1;
  double width = 10;          ///< of a block along x
  double surface_margin = 3;  ///< depth below z = 0 and below the surface at that x, nu = least_nu
  double wall_margin = 4;     ///< grains order along the wall
  double least_nu = 0.6;
  double least_signal = 2;  ///< the strain rate over its standard error
  /// Velocity gradients from displacements between snapshots (displacement_..) in blocks where the map has
  /// them at every node.
  bool displacements = false;
};

/// One block. friction.mu is the stress along the strain rate over the pressure, tau:D/(2 |D| p), and
/// friction.I = 2|D|/sqrt(p) with |D|^2 less its variance. In simple shear they are 2 mu/(1 + k) and
/// I sqrt(2/(1 + k)) of sigma_xz/sigma_zz and (dv_x/dz)/sqrt(sigma_zz).
struct LawBlock {
  double x = 0, z = 0;  ///< middle of the block, d
  FrictionPoint friction;
  double turn = 0;  ///< stress across the strain rate over the pressure: (k - 1)/(k + 1) in simple shear
  double turn_error = 0;
  double strain_rate = 0;  ///< 2|D|
  double p = 0;
  double stress_ratio = 0;  ///< |s|/p, s the deviator of the stress, |s| = sqrt(s:s/2), less its variance
  double stress_ratio_error = 0;
  double dilatancy = 0;  ///< div v/(2|D|)
};

/// Column of blocks after column from -x to x, each from below to above, so that neighbours stand next to
/// each other. Errors from those of the nodes, two neighbouring nodes counting as one (they share their
/// kernel). Needs the fields nu, sigma_.., d_v_.., and the header's axis_depth and drum_radius (both 0: no
/// drum, no wall margin). Throws InputError when one is missing.
std::vector<LawBlock> law_points(const FieldMap& map, const BlockSelection& selection = {});

/// Friction and inertial number of each point for a law without k.
std::vector<FrictionPoint> frictions(const std::vector<LawBlock>& points);

/// The turn of each point over its inertial number, in the place of mu.
std::vector<FrictionPoint> turns(const std::vector<LawBlock>& points);

/// The amount of the stress |s|/p of each point over its inertial number, in the place of mu.
std::vector<FrictionPoint> stress_ratios(const std::vector<LawBlock>& points);

/// Friction and inertial number for a law with k, the ratios of simple shear: mu = M (1 + k)/2 and
/// I = I_p sqrt((1 + k)/2) of a point's M and I_p, k that of the smooth law there (shear_state()).
std::vector<FrictionPoint> frictions_with_k(const std::vector<LawBlock>& points, const StressRatioLaw& k);

/// Angle by which the axes of stress are turned from those of the strain rate, in degrees, with the sign of
/// axis_angle_deg(): tan(2 angle) = turn/friction, both over the pressure.
double turn_angle_deg(double turn, double friction);

}  // namespace drumlin::coupling
