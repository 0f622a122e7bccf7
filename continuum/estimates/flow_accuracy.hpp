#pragma once
// A-posteriori error of each scalar of a solved flow, by source, and the price of halving it.
#include <optional>
#include <string>
#include <vector>

#include "continuum/estimates/law_band.hpp"
#include "continuum/estimates/sensitivity.hpp"

namespace drumlin::continuum {

/// One source of error in one scalar.
struct ErrorPart {
  std::string source;           ///< "mesh", "eps", "iteration"
  std::optional<double> error;  ///< absent: not known
};

struct ScalarAccuracy {
  std::string name;
  double value = 0;
  std::vector<ErrorPart> parts;
  std::optional<double> by_p_min;  ///< what p_min - 20 % changes: a choice of the model, no error
  std::optional<double> by_law;    ///< half width of the 99 % interval that the draws of the law give

  /// Sum of what is known; absent where nothing is.
  std::optional<double> error() const;
  /// The largest of them; empty where nothing is known.
  std::string dominant() const;
};

/// What the error of one source would shrink to half by.
struct Halving {
  std::string source;
  std::vector<std::string> changes;  ///< as for --set; empty: one more iteration
  double cpu_seconds = 0;            ///< of the whole solve with them, estimated
};

/// Changes of the scene, as for --set, that give one mesh more than `levels`, of cells half as large.
std::vector<std::string> finer_mesh(const FlowScene& scene, int levels);

/// What the errors are estimated from: results that exist, no further solve.
struct AccuracyEvidence {
  const FlowReport& report;
  const std::vector<MeshResult>& meshes;          ///< from coarse to fine
  const std::vector<Sensitivity>& sensitivities;  ///< empty: not computed
  const LawBand& law_band;                        ///< without draws: not computed
  double cpu_seconds = 0;                         ///< of the solve
};

/// Empty for a march: it has one mesh and no sensitivities.
struct FlowAccuracy {
  std::vector<ScalarAccuracy> scalars;
  std::vector<Halving> halvings;
};

/// The error of the mesh is the distance to the limit that three meshes show, and where they show none what
/// the last halving of the cells changed: an upper bound as long as changes at least halve. That of eps is
/// 4/3 of what eps / 4 changes, exact where it goes with eps. That of the iteration is what one more step
/// changes.
FlowAccuracy accuracy_of(const FlowScene& scene, const AccuracyEvidence& evidence);

}  // namespace drumlin::continuum
