#include "continuum/model/scene_effects.hpp"

#include "continuum/rheology/nonlocal_law.hpp"
#include "coupling/common/errors.hpp"

namespace drumlin::continuum {
namespace {

void check_law(const FlowEffects& effects, const RheologyFit& law, const StressLaw& mu) {
  std::vector<InputProblem> problems;
  if (effects.fabric && !law.k)
    problems.push_back({.file = "",
                        .key = "effects.fabric",
                        .what = "carries k along with the material, and the law has no k",
                        .allowed = "a rheology file with a table [k]"});
  if (effects.memory && !law.memory)
    problems.push_back({.file = "",
                        .key = "effects.memory",
                        .what = "carries the axes of past strain along, and the law has no table [memory]",
                        .allowed = "a rheology file with a table [memory]"});
  if (effects.memory && law.k)
    problems.push_back({.file = "",
                        .key = "effects.memory",
                        .what = "turns the axes of the stress, and so does the k of the law",
                        .allowed = "a rheology file without a table [k]"});
  if (effects.nonlocal && !effects.memory && !tells_fluidity(mu))
    problems.push_back(
        {.file = "",
         .key = "effects.nonlocal",
         .what = "spreads the fluidity that mu determines, and the law's mu is the same at all rates "
                 "or has a threshold, below which it determines none",
         .allowed = "a rheology file whose mu is a logarithm or a table"});
  if (!problems.empty()) throw InputError(problems);
}

}  // namespace

void add_law_and_effects(const FlowScene& scene, const RheologyFit& law, FlowProblem& problem) {
  const FlowEffects& effects = scene.effects;
  problem.law = stress_law(law);
  check_law(effects, law, problem.law);
  if (law.k) problem.turned = TurnedStress{.k = StressRatioLaw(law.k->I, law.k->k)};
  if (effects.fabric) problem.turned->fabric = CarriedFabric{effects.fabric->relaxation};
  if (effects.nonlocal) problem.nonlocal = NonlocalFluidity{effects.nonlocal->length};
  if (effects.memory) problem.memory.emplace(*law.memory);
  if (effects.inertia) problem.inertia = Inertia{};
}

void refuse_effects_of_the_drum(const FlowEffects& effects) {
  std::vector<InputProblem> problems;
  const auto refuse = [&](bool named, const char* key) {
    if (named)
      problems.push_back(
          {.file = "", .key = key, .what = "belongs to a drum", .allowed = "absent without [drum]"});
  };
  refuse(effects.rotating_frame.has_value(), "effects.rotating_frame");
  refuse(effects.wall_slip.has_value(), "effects.wall_slip");
  refuse(effects.moving_surface.has_value(), "effects.moving_surface");
  if (!problems.empty()) throw InputError(problems);
}

}  // namespace drumlin::continuum
