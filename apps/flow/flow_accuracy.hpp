#pragma once
// How far a finished flow may be from the exact solution of its equations, and what half of that would cost.
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/flow/flow_files.hpp"

namespace drumlin::apps {

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

/// From the meshes and the sensitivities of a flow, without another solve. The error of the mesh is the
/// distance to the limit that three meshes show, and where they show none what the last halving of the cells
/// changed: an upper bound as long as changes at least halve. That of eps is 4/3 of what eps / 4 changes,
/// exact where it goes with eps. That of the iteration is what one more step changes.
std::vector<ScalarAccuracy> accuracy_of(const FinishedFlow& flow);
std::vector<Halving> halvings_of(const FinishedFlow& flow);

/// The same as in flow.json (docs/formats/flow.md), null for a march.
nlohmann::ordered_json accuracy_json(const FinishedFlow& flow);
std::string accuracy_text(const FinishedFlow& flow);

}  // namespace drumlin::apps
