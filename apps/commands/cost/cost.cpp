// drumlin cost: what accuracy costs, and what each effect; the kind of the scene decides how it is found out.
#include "apps/commands/cost/cost.hpp"

#include "apps/commands/cost/flow_points.hpp"
#include "apps/commands/cost/sweep.hpp"
#include "coupling/common/errors.hpp"
#include "coupling/documents/document.hpp"

namespace drumlin::apps {
namespace {

bool is_flow_scene(const std::filesystem::path& file) {
  const Document document = read_toml(file);
  const Node* format = document.root.find("format");
  const auto* text = format != nullptr ? std::get_if<std::string>(&format->value) : nullptr;
  if (text != nullptr && text->starts_with("drumlin-flow-scene-")) return true;
  if (text != nullptr && text->starts_with("drumlin-scene-")) return false;
  throw InputError({InputProblem{.file = file.string(),
                                 .line = format != nullptr ? format->line : 0,
                                 .key = "format",
                                 .what = "is no scene that can be priced",
                                 .allowed = "drumlin-scene-1, drumlin-flow-scene-1"}});
}

void refuse_options_of_the_other_kind(const CostOptions& options, bool flow) {
  if (flow && (options.from || options.statistics_s))
    throw InputError("cost: --from and --statistics are for scenes of particles");
  if (!flow && (asks_for_work(options) || options.time_limit_s || !options.variants.empty() ||
                !options.against.empty()))
    throw InputError(
        "cost: --ranks, --neighbour, --repeats, --time-limit, --variants and --against are for flows");
}

}  // namespace

int cost(const CostOptions& options) {
  const bool flow = is_flow_scene(options.scene);
  if (flow && !options.rheology)
    throw InputError(options.scene.string() + ": a flow scene needs --rheology RHEOLOGY.toml");
  refuse_options_of_the_other_kind(options, flow);
  if (options.effects) return flow ? price_flow_effects(options) : price_particle_effects(options);
  return flow ? sweep_flow(options) : sweep_particles(options);
}

}  // namespace drumlin::apps
