#pragma once
// What the geometry of a scene contributes to a flow: the problem, and how a solution is read. Chosen once.
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "continuum/fem/flow_field.hpp"
#include "continuum/model/flow_scene.hpp"
#include "continuum/sampling/flow_maps.hpp"
#include "continuum/sampling/gap_profiles.hpp"
#include "coupling/exchange/profile_set.hpp"
#include "coupling/exchange/scalar_set.hpp"

namespace drumlin {

struct FlowCase {
  std::string geometry;  ///< name of the table of the scene
  std::string summary;   ///< one line: the geometry in d and sqrt(d/g)
  FlowProblem problem;
  ScalarSet given;     ///< numbers that stand beside the results: nu, the height of the axis
  ScalarSet settings;  ///< of the geometry
  std::function<std::vector<std::pair<std::string, std::string>>(const FlowField&)> profile_header;
  std::function<ProfileSet(const FlowField&)> profiles;
  std::function<ScalarSet(const FlowField&)> scalars;
  std::function<ScalarSet(const FlowField&)> checks;           ///< identities of the exact flow
  std::function<GapComparison(const FlowField&)> closed_form;  ///< empty: there is none
  std::function<MapArea(const FlowField&)> map_area;
};

/// Throws InputError if the grains do not fit into a drum.
FlowCase flow_case(const FlowScene& scene, double nu, const StressLaw& law);

}  // namespace drumlin
