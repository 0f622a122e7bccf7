#pragma once
// 99 % intervals of a flow's results from other draws of the points that its law was fitted on.
#include <vector>

#include "continuum/fem/flow_solver.hpp"
#include "continuum/postprocessing/flow_case.hpp"
#include "coupling/core/results/field_map.hpp"

namespace drumlin::continuum {

/// Half widths of the 99 % intervals that the laws of other draws give: Student's t times the standard
/// deviation of the flows solved with them.
struct LawBand {
  int draws = 0;       ///< laws that were solved
  int found = 0;       ///< of them converged; the widths are theirs
  int iterations = 0;  ///< over all of them
  double seconds = 0;
  ScalarSet scalars;                          ///< half widths
  double profile = 0;                         ///< of v_x: rms of the half width over rms of v_x
  std::vector<std::vector<double>> profiles;  ///< per column of the profile
  std::vector<std::vector<double>> maps;      ///< per field of the map
};

/// Solves the flow again with the first `draws` laws of `fit.draws`, on the last mesh, from its own state; k
/// stays as it is. A law whose flow does not converge is skipped. map_spacing in d. Collective.
LawBand law_band_of(const FlowCase& flow_case, const FlowSolution& solution, const RheologyFit& fit,
                    int draws, double map_spacing, const FlowSolverOptions& options);

/// Gives each column and field its half widths.
void add_band(const LawBand& band, ProfileSet& profiles);
void add_band(const LawBand& band, FieldMap& maps);

}  // namespace drumlin::continuum
