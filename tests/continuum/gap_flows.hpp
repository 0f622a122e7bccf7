#pragma once
// Flows across a gap that small meshes resolve.
#include <numbers>

#include "continuum/model/gap.hpp"

namespace drumlin::testing_gaps {
using namespace continuum;

constexpr double nu = 0.82;
// A steeper law than the paper's: its shear layers are wide enough for small meshes.
const LogLaw steep{0.35, 0.05};

struct GapFlow {
  Gap gap;
  double cell = 0;  ///< on the finest of three meshes
  FlowRegularisation regularisation;
};

/// p_min takes the root of the shear rate away from the surface, where Q2 would be of order 2.
inline GapFlow incline_flow(double theta_deg = 18) {
  return {{.depth = 10,
           .nu = nu,
           .weight = nu,
           .slope = theta_deg * std::numbers::pi / 180,
           .scalars = {"surface_speed", "mu_wall"}},
          0.5,
          {.shear_rate = 1e-5, .pressure = 1}};
}
inline GapFlow chute_flow() {
  return {{.depth = 4,
           .nu = nu,
           .weight = nu,
           .slope = 0.5 * std::numbers::pi,
           .pressure = 11,
           .flows_at_wall = true,
           .scalars = {"Q", "mu_wall"}},
          0.1,
          {.shear_rate = 1e-3, .pressure = 1e-3}};
}
inline GapFlow annulus_flow() {
  return {{.depth = 4,
           .inner_radius = 6,
           .nu = nu,
           .pressure = 4,
           .speed = 0.5,
           .scalars = {"torque", "mu_wall"}},
          0.25,
          {.shear_rate = 1e-3, .pressure = 1e-3}};
}

}  // namespace drumlin::testing_gaps
