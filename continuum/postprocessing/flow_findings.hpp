#pragma once
// Numbers read off a solved flow: scalars per mesh, integrals, checks, neglected terms, and what k or
// nonlocal fluidity changed.
#include <optional>
#include <string>
#include <vector>

#include "continuum/fem/neglected_terms.hpp"
#include "continuum/model/mesh_limit.hpp"
#include "continuum/postprocessing/flow_case.hpp"

namespace drumlin::continuum {

/// Size and scalars of the flow on one mesh.
struct MeshResult {
  int level = 0;  ///< 0: the coarsest mesh of the scene
  int cells = 0;
  int unknowns = 0;
  ScalarSet scalars;
};

/// Limit of a scalar over the meshes; without a value where mesh_limit() gives none.
struct ScalarLimit {
  std::string name;
  std::optional<MeshLimit> limit;
};
/// Of meshes from coarse to fine, one at least, that all have the scalars of the last.
std::vector<ScalarLimit> limits_of(const std::vector<MeshResult>& meshes);

/// What is read off the last field, once.
struct FlowFindings {
  FlowIntegrals sums;
  ScalarSet checks;
  std::optional<GapComparison> closed_form = {};  ///< across a gap
  std::optional<NeglectedTerms> neglected = {};   ///< of a drum
  /// How much of the answer is eps's: of a flow that its weight drives across a gap the share of its speed
  /// that goes with eps, of one that a wall drives the share of the law's strength that its shear rates lack.
  double eps_share = 0;
  double ill_posed_share() const { return sums.ill_posed_area / sums.area; }
  double beyond_law_share() const { return sums.beyond_law_area / sums.area; }
};
/// `checks`: those of this field (FlowCase::checks). Collective.
FlowFindings findings_of(const FlowCase& flow_case, const FlowField& field, ScalarSet checks);

/// The same flow on the last mesh without the fields that the law takes from the flow: k, nonlocal fluidity.
struct PlainFlow {
  ScalarSet scalars;
  ProfileSet profiles;
  double v_x_change = 0;  ///< v_x_change() to the flow with them
};

/// Root mean square of the difference of v_x over that of the second, over the layers of two profiles of the
/// same layers; layers where either is not finite are skipped.
double v_x_change(const ProfileSet& without, const ProfileSet& with);

/// changed - unchanged for every scalar of `unchanged`.
ScalarSet difference(const ScalarSet& changed, const ScalarSet& unchanged);

}  // namespace drumlin::continuum
