#pragma once
// What eps, p_min and the mesh may be blamed for in a finished flow.
#include <string>
#include <vector>

#include "apps/flow/flow_files.hpp"

namespace drumlin::apps {

/// The change of every scalar of the flow, and of its profile of v_x (relative, in L2), from one changed
/// setting.
struct Sensitivity {
  std::string setting;  ///< "eps / 4", "p_min - 20 %", "last halving of the cells"
  bool found = false;   ///< false: the flow with that setting did not converge, or there is no coarser mesh
  ScalarSet changes;    ///< changed minus unchanged
  double profile = 0;   ///< nan for the mesh
  int iterations = 0;   ///< that it took
};

/// Solves the flow twice more on its last mesh, from its own state. Collective.
std::vector<Sensitivity> sensitivities_of(const FlowCase& flow_case, const FlowSolution& solution,
                                          const std::vector<MeshResult>& meshes,
                                          const FlowSolverOptions& options);

/// One line per scalar: value, and what each setting moves in it.
std::string sensitivity_text(const FinishedFlow& flow);

}  // namespace drumlin::apps
