#pragma once
// What a flow leaves in FLOWRUN (docs/formats/flow.md).
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "continuum/fem/flow_solver.hpp"
#include "continuum/model/mesh_limit.hpp"
#include "continuum/sampling/flow_case.hpp"
#include "coupling/exchange/profile_set.hpp"
#include "coupling/exchange/rheology_fit.hpp"
#include "coupling/exchange/scalar_set.hpp"

namespace drumlin::apps {

/// Size and scalars of the flow on one mesh.
struct MeshResult {
  int level = 0;  ///< 0: the coarsest mesh of the scene
  int cells = 0;
  int unknowns = 0;
  ScalarSet scalars;
};

/// What each scalar tends to over the meshes; without a value where mesh_limit() gives none.
struct ScalarLimit {
  std::string name;
  std::optional<MeshLimit> limit;
};
std::vector<ScalarLimit> limits_of(const std::vector<MeshResult>& meshes);

struct Sensitivity;
struct LawBand;

/// What is read off the last field, once.
struct FlowFindings {
  FlowIntegrals sums;
  ScalarSet checks;
  std::optional<GapComparison> closed_form = {};  ///< across a gap
  std::optional<LeftOut> left_out = {};           ///< of a drum
};
/// Collective.
FlowFindings findings_of(const FlowCase& flow_case, const FlowField& field);
/// The same flow on the last mesh, before what the law holds of the flow entered: k, nonlocal fluidity.
struct PlainFlow {
  ScalarSet scalars;
  ProfileSet profiles;
  double v_x_change = 0;  ///< v_x_change() to the flow with them
};
/// Root mean square of the difference of v_x over that of the second, over the layers of two profiles.
double v_x_change(const ProfileSet& without, const ProfileSet& with);

/// Everything that describes one finished flow.
struct FinishedFlow {
  const FlowScene& scene;
  const RheologyFit& law;
  const FlowCase& flow_case;
  const FlowSolution& solution;
  const std::vector<MeshResult>& meshes;  ///< the last one carries the result
  bool reduced = false;
  int ranks = 1;
  const std::vector<Sensitivity>& sensitivities;  ///< empty: not asked for
  const LawBand& law_band;                        ///< without draws: not asked for
  const FlowFindings& findings;
  std::optional<PlainFlow> plain = {};  ///< absent where the law holds nothing
  double cpu_seconds = 0;               ///< of the solve, on this rank
};

/// Named, or brought along by steps in time.
inline bool has_inertia(const FlowScene& scene) { return scene.effects.inertia || scene.time; }

/// iterations.csv: one line per nonlinear iteration; also for a flow that did not converge.
void write_iterations(const std::filesystem::path& file, const FlowReport& report);

/// profiles.csv, maps.h5, flow.vtu, state.h5, the figures, and last of all flow.json: where that stands, all
/// is there. Collective; the first rank writes.
void write_flow(const std::filesystem::path& folder, const FinishedFlow& flow);

}  // namespace drumlin::apps
