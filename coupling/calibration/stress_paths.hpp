#pragma once
// Mean paths of the material, traced back from nodes of a map, with what they pass through.
#include <cstddef>
#include <vector>

#include "coupling/calibration/path_fields.hpp"

namespace drumlin::coupling {

/// A stretch of a path over which everything is constant.
struct PathStep {
  double strain = 0;     ///< |D| t
  double turn = 0;       ///< W t, rad
  Deviator axis;         ///< n = D/|D|
  double ln_I = 0;       ///< of I = 2|D|/sqrt(p)
  double dilatancy = 0;  ///< div v/(2|D|)
  double p = 0;          ///< rho0 g d
};

/// A node and the path of the material that is there now.
struct StressPath {
  double x = 0, z = 0;
  double depth_angle = 0;       ///< about the drum's axis, rad from straight below it, positive downslope
  double radius = 0;            ///< distance from the drum's axis, d
  Deviator axis;                ///< n at the node
  double ln_I = 0;              ///< at the node
  double spin_share = 0;        ///< |W|/|D| at the node
  Deviator stress;              ///< s/p at the node
  double p = 0;                 ///< at the node, rho0 g d
  std::vector<PathStep> steps;  ///< from the oldest to the node
};

struct PathOptions {
  double surface_margin = 3;  ///< d, nodes keep it from z = 0 and from the surface at their x
  double wall_margin = 4;     ///< d: grains order along the wall
  double I_min = 3e-6;
  std::size_t stride = 3;  ///< every so many columns and rows: neighbours share their kernels
  double step = 1;         ///< d along the path
  double strain = 1.5;     ///< of |D| t, after which nothing before is asked for: e^(-2 c 1.5) of it is left
  std::size_t most_steps = 600;
};

/// One path per node of the map that lies in the packing as `options` say, column after column from -x to x,
/// each from below to above.
std::vector<StressPath> stress_paths(const PathFields& fields, const PathOptions& options = {});

/// I = 2|D|/sqrt(p + w) in place of 2|D|/sqrt(p) at every node and along every path.
void add_own_weight(std::vector<StressPath>& paths, double w);

}  // namespace drumlin::coupling
