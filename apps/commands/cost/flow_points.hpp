#pragma once
// Flows as points of a sweep: each solved by drumlin-flow, of which nothing but its numbers is kept.
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "apps/commands/cost/sweep.hpp"

namespace drumlin::apps {

struct FlowToSolve {
  std::string name;
  std::filesystem::path scene;
  std::filesystem::path rheology;
  std::vector<std::string> changes;  ///< as for --set, beside no sensitivities and no figures
};

/// Cost, scalars and profile of v_x of the flow (docs/formats/cost.md), from its file or solved now.
/// "failure" in place of results where it did not converge. Throws InputError for what drumlin-flow refuses,
/// IoError, Interrupted.
nlohmann::ordered_json solved_point(const PointStore& store, const FlowToSolve& flow);

/// The plain name of a scalar and its value, of a point that converged.
std::vector<std::pair<std::string, double>> scalars_of(const nlohmann::ordered_json& point);

/// Relative differences of all scalars to those of `reference`, and "v_x": rms of the difference of the
/// profiles over rms of the reference's. Scalars that are 0 there are left out.
nlohmann::ordered_json relative_differences(const nlohmann::ordered_json& point,
                                            const nlohmann::ordered_json& reference);

}  // namespace drumlin::apps
