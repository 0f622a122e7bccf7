#pragma once
// What a converged flow must still meet to be one of its equations, and meshes added where the last is too
// coarse.
#include <functional>
#include <string>
#include <vector>

#include "continuum/fem/flow_solver.hpp"
#include "continuum/postprocessing/flow_findings.hpp"

namespace drumlin::continuum {

inline constexpr double largest_flux_imbalance = 1e-3;
/// FlowFindings::eps_share; above most_creep_share a layer that its weight drives does not flow.
inline constexpr double largest_eps_share = 0.1, most_creep_share = 0.5;
inline constexpr int most_added_unknowns = 1'000'000;  ///< of an added mesh

/// Meshes beyond those of the scene.
struct FlowOnFinerMeshes {
  std::vector<double> imbalance;  ///< flux_imbalance, before and on each that was added; empty: no drum
  std::string failure;            ///< of the mesh after these; empty: none failed
  ScalarSet checks;               ///< of the solution (FlowCase::checks)
};

/// Halves the cells of a steady drum as long as its flux_imbalance is too large, its surface does not leak
/// that much, and FlowSolverOptions::further_levels and most_added_unknowns allow; not where the scene halves
/// but a share of them. `solution` becomes the flow on the last mesh that converged; `adding` hears of each.
/// Collective.
FlowOnFinerMeshes add_meshes(const FlowScene& scene, const FlowCase& flow_case, FlowSolution& solution,
                             const FlowObserver& observer,
                             const std::function<void(double imbalance)>& adding);

/// What the flow misses and what would help, a sentence each; empty: it is a flow of its equations.
std::vector<std::string> missed_limits(const FlowScene& scene, const FlowCase& flow_case,
                                       const std::vector<MeshResult>& meshes, const FlowFindings& findings,
                                       const FlowOnFinerMeshes& finer);

}  // namespace drumlin::continuum
