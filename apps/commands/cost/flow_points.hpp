#pragma once
// Flows as points of a sweep: each solved by drumlin-flow, of which nothing but its numbers is kept.
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/commands/cost/sweep.hpp"
#include "apps/support/commands.hpp"
#include "coupling/accuracy/flow_sweep.hpp"

namespace drumlin::apps {

/// A flow to be solved, and how.
struct FlowToSolve {
  std::string name;
  std::filesystem::path scene;
  std::filesystem::path rheology;
  std::vector<std::string> changes;                ///< as for --set, beside no sensitivities and no figures
  int ranks = 1;                                   ///< more than 1: by mpirun
  std::optional<std::filesystem::path> from = {};  ///< folder of a neighbour to start from
  std::optional<double> time_limit_s = {};
  std::vector<std::filesystem::path> against = {};  ///< measured runs that it is compared with
};

/// Cost, scalars and profile of v_x of the flow (docs/formats/cost.md), from its file or solved now.
/// "failure" in place of results where it did not converge within its time. Throws InputError for what
/// drumlin-flow refuses, IoError, Interrupted.
nlohmann::ordered_json solved_point(const PointStore& store, const FlowToSolve& flow);

/// What the flow costs cold and from its neighbour, on each number of ranks, each repeated, as --ranks,
/// --neighbour and --repeats ask for: a list as under "work" in docs/formats/cost.md. `once` is the flow
/// solved cold on one rank.
nlohmann::ordered_json work_of(const PointStore& store, const FlowToSolve& flow,
                               const nlohmann::ordered_json& once, const CostOptions& options);
/// Whether the options ask for more than one solve of each flow.
bool asks_for_work(const CostOptions& options);

/// What all points of a sweep or price list share beside the scene: the law, and the options that change
/// points.
nlohmann::ordered_json shared_by_flows(const std::string& kind, const CostOptions& options);

/// The numbers of a point that converged.
coupling::FlowNumbers numbers_of_point(const nlohmann::ordered_json& point);

}  // namespace drumlin::apps
