#pragma once
// Sensitivity of a solved flow to eps, p_min, the mesh and the end of the iteration.
#include <string>
#include <vector>

#include "continuum/fem/flow_solver.hpp"
#include "continuum/postprocessing/flow_findings.hpp"

namespace drumlin::continuum {

inline constexpr const char* finer_shear_rate = "eps / 4";
inline constexpr const char* weaker_pressure = "p_min - 20 %";
inline constexpr const char* one_more_iteration = "one more iteration";
inline constexpr const char* last_halving = "last halving of the cells";

/// The change of every scalar of the flow, and of its profile of v_x (relative, in L2), from one changed
/// setting.
struct Sensitivity {
  std::string setting;  ///< one of the names above
  bool found = false;   ///< false: the flow with that setting did not converge, or there is no coarser mesh
  ScalarSet changes;    ///< changed minus unchanged
  double profile = 0;   ///< nan for the mesh
  int iterations = 0;   ///< that it took
  double cpu_seconds = 0;
};

/// Solves the flow again on its last mesh, from its own state, with either setting and with one more step of
/// the iteration (one more Picard update where the law takes fields from the flow). `meshes`: results from
/// coarse to fine, the last one that of `solution`. Collective.
std::vector<Sensitivity> sensitivities_of(const FlowCase& flow_case, const FlowSolution& solution,
                                          const std::vector<MeshResult>& meshes,
                                          const FlowSolverOptions& options);

}  // namespace drumlin::continuum
