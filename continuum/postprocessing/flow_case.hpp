#pragma once
// The complete problem of a scene and a law, and how its solution is read: chosen once by geometry.
#include <functional>
#include <limits>
#include <string>

#include "continuum/fem/flow_field.hpp"
#include "continuum/model/flow_scene.hpp"
#include "continuum/postprocessing/flow_maps.hpp"
#include "continuum/postprocessing/gap_profiles.hpp"
#include "coupling/core/law/rheology_fit.hpp"
#include "coupling/core/results/profile_set.hpp"
#include "coupling/core/results/scalar_set.hpp"

namespace drumlin::continuum {

struct FlowCase {
  Geometry geometry = Geometry::drum;
  std::string summary;                                         ///< one line: the geometry in d and sqrt(d/g)
  FlowProblem problem;                                         ///< complete: nothing is added to it
  double law_I_max = std::numeric_limits<double>::infinity();  ///< largest I that its law was measured at
  ScalarSet given;     ///< numbers that stand beside the results: nu, the height of the axis
  ScalarSet settings;  ///< of the geometry
  std::function<RunHeader(const FlowField&)> profile_header;  ///< frame and geometry alone
  std::function<ProfileSet(const FlowField&)> profiles;
  std::function<ScalarSet(const FlowField&)> scalars;
  std::function<ScalarSet(const FlowField&)> checks;           ///< identities of the exact flow
  std::function<GapComparison(const FlowField&)> closed_form;  ///< empty: there is none
  std::function<MapArea(const FlowField&)> map_area;
};

/// Throws InputError if the grains do not fit into a drum, or the law does not allow an effect of the scene
/// (problems without a file: the caller knows its name).
FlowCase flow_case(const FlowScene& scene, const RheologyFit& law);

}  // namespace drumlin::continuum
