#pragma once
// A-posteriori size of each neglected term.
#include <optional>

#include "continuum/fem/flow_field.hpp"

namespace drumlin::continuum {

/// Estimates from the flow itself; no errors of results.
struct NeglectedTerms {
  double inertia_rms = 0;         ///< of |u.grad u| over gravity, over the area
  double inertia_largest = 0;     ///< at the quadrature points
  double surface_height_rms = 0;  ///< d: of the height sigma_nn/(nu cos theta) that would take the place of
                                  ///< the traction which holds the surface where it is
  double wall_friction = 0;       ///< share of the wall that needs a shear stress above 0.95 of the pressure
  /// Over what flows (I > 1e-3, p > 1): rms of ln(g/g_loc) for a nonlocal length of 1 d. Absent where the law
  /// determines no fluidity.
  std::optional<double> nonlocal;
};

/// Of a solved flow of any geometry. Collective. Throws NotConvergedError where a linear solve misses its
/// tolerance.
NeglectedTerms neglected_terms(const FlowField& field);

}  // namespace drumlin::continuum
